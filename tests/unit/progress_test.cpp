#include "base/progress.h"

#include <limits>

#include <gtest/gtest.h>

namespace tachylite {
namespace {

TEST(Progress, Durations) {
  EXPECT_EQ(format_duration(0), "0.0 s");
  EXPECT_EQ(format_duration(59.94), "59.9 s");
  EXPECT_EQ(format_duration(59.96), "1:00");
  EXPECT_EQ(format_duration(3599.6), "1:00:00");
  EXPECT_EQ(format_duration(3723), "1:02:03");
  EXPECT_EQ(format_duration(-1), "?");
  EXPECT_EQ(format_duration(std::numeric_limits<double>::infinity()), "?");
}

TEST(Progress, SaysWhatIsKnown) {
  ProgressFigures f{0.25, 16, 64, 10, 1.234, 0.0123};
  EXPECT_EQ(format_progress(f), " 25 %  16/64 samples  30.0 s left  1.23 Mpaths/s  error 1.2 %");
  f = {-1, 16, 0, 10, 0, 0};
  EXPECT_EQ(format_progress(f), "16 samples  10.0 s");
}

TEST(Progress, BarFillsTheRoomAndNoMore) {
  const ProgressFigures f{0.5, 32, 64, 10, 1, 0};
  for (int columns = 0; columns < 200; ++columns)
    EXPECT_LE(format_progress_bar(f, columns).size(), static_cast<size_t>(columns));
  EXPECT_EQ(format_progress_bar(f, 70).substr(0, 1), "[");
  EXPECT_NE(format_progress_bar(f, 120).find("[####################--------------------]"),
            std::string::npos);
  EXPECT_EQ(format_progress_bar(f, 40).find('['), std::string::npos);
}

TEST(Progress, SilentWhenQuietAndForShortRenders) {
  for (const bool quiet : {true, false}) {
    std::FILE* file = std::tmpfile();
    ProgressDisplay display(quiet, file);
    for (int i = 0; i <= 10; ++i) display.update({0.1 * i, 1, 10, 1, 1, 0});
    display.finish();
    std::fflush(file);
    EXPECT_EQ(std::ftell(file), 0);  // not a terminal, and less than 10 s
    std::fclose(file);
  }
}

}  // namespace
}  // namespace tachylite
