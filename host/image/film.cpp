#include "image/film.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"

namespace tachylite {
namespace {

constexpr const char* kColors[] = {"R", "G", "B"};
constexpr const char* kRangesKey = "sample_ranges";
constexpr const char* kBlocksKey = "blocks";
constexpr const char* kCountKey = "sample_count_channel";
constexpr size_t kPixelsAtOnce = 4096;

std::string word_channel(const std::string& sum, size_t word) { return fmt::format("{}.{}", sum, word); }
std::string sum_name(const std::string& channel) { return kSumsLayer + channel; }

/// The number that `text` begins with, taken off; false when there is none.
bool take_number(std::string_view& text, uint64_t& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return true;
}
bool take_character(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

/// The inverse of format_ranges; empty for what it does not write.
std::vector<SampleRange> parse_ranges(std::string_view text) {
  std::vector<SampleRange> ranges;
  uint64_t free_from = 0;
  do {
    uint64_t first = 0, last = 0;
    if (!take_number(text, first) || !take_character(text, '-') || !take_number(text, last) || first < free_from ||
        last < first || last >= uint64_t{1} << 32)
      return {};
    ranges.push_back({first, last + 1 - first});
    free_from = last + 2;
  } while (take_character(text, ','));
  return text.empty() ? ranges : std::vector<SampleRange>{};
}

}  // namespace

std::string format_ranges(const std::vector<SampleRange>& ranges) {
  std::string text;
  for (const SampleRange& r : ranges) text += fmt::format("{}{}-{}", text.empty() ? "" : ",", r.first, r.end() - 1);
  return text;
}

FilmBuffer::FilmBuffer(int width, int height, std::vector<std::string> extra_channels, std::string count_channel)
    : width_(width), height_(height), extra_names_(std::move(extra_channels)), count_channel_(std::move(count_channel)) {
  for (ReproducibleSums& s : sums_) s = ReproducibleSums(pixels());
  for (ReproducibleSums& s : squares_) s = ReproducibleSums(pixels());
  extra_.assign(extra_names_.size(), ReproducibleSums(pixels()));
}

uint64_t FilmBuffer::samples() const {
  uint64_t sum = 0;
  for (const SampleRange& r : ranges_) sum += r.count;
  return sum;
}

double FilmBuffer::mean_samples() const {
  uint64_t sum = 0;
  for (const OwnBlocks& own : own_) sum += own.samples;
  return static_cast<double>(samples()) + static_cast<double>(sum) / static_cast<double>(pixels());
}

void FilmBuffer::finish_own_blocks(size_t index, uint64_t blocks, uint64_t samples) {
  if (own_.empty()) own_.resize(pixels());
  own_[index].blocks += static_cast<uint32_t>(blocks);
  own_[index].samples += static_cast<uint32_t>(samples);
}

void FilmBuffer::finish_blocks(const SampleRange& range, uint64_t blocks) {
  blocks_ += blocks;
  const auto after = std::find_if(ranges_.begin(), ranges_.end(),
                                  [&](const SampleRange& r) { return r.first >= range.end(); });
  CHECK(after == ranges_.begin() || std::prev(after)->end() <= range.first);
  ranges_.insert(after, range);
  // Join what touches.
  std::vector<SampleRange> joined;
  for (const SampleRange& r : ranges_) {
    if (!joined.empty() && joined.back().end() == r.first)
      joined.back().count += r.count;
    else
      joined.push_back(r);
  }
  ranges_ = std::move(joined);
}

void FilmBuffer::merge(const FilmBuffer& other) {
  CHECK(!is_adaptive() && !other.is_adaptive());
  CHECK(blocks_ + other.blocks_ <= ReproducibleSums::kMaxValues);
  CHECK_EQ(width_, other.width_);
  CHECK_EQ(height_, other.height_);
  CHECK_EQ(extra_names_.size(), other.extra_names_.size());
  for (size_t c = 0; c < 3; ++c) {
    sums_[c].add(other.sums_[c]);
    squares_[c].add(other.squares_[c]);
  }
  for (size_t c = 0; c < extra_.size(); ++c) {
    const auto found = std::find(other.extra_names_.begin(), other.extra_names_.end(), extra_names_[c]);
    CHECK(found != other.extra_names_.end());
    extra_[c].add(other.extra_[static_cast<size_t>(found - other.extra_names_.begin())]);
  }
  for (const SampleRange& range : other.ranges_) finish_blocks(range, 0);
  blocks_ += other.blocks_;
}

glm::dvec3 FilmBuffer::mean(size_t index) const {
  const double n = static_cast<double>(std::max<uint64_t>(samples_of(index), 1));
  return glm::dvec3(sums_[0].value(index), sums_[1].value(index), sums_[2].value(index)) / n;
}

double FilmBuffer::extra_mean(size_t index, size_t channel) const {
  return extra_[channel].value(index) / static_cast<double>(std::max<uint64_t>(samples_of(index), 1));
}

glm::dvec3 FilmBuffer::variance_of_mean(size_t index) const {
  if (!has_variance()) return glm::dvec3(0);
  const double n = static_cast<double>(samples_of(index));
  const glm::dvec3 sum(sums_[0].value(index), sums_[1].value(index), sums_[2].value(index));
  const glm::dvec3 square(squares_[0].value(index), squares_[1].value(index), squares_[2].value(index));
  const glm::dvec3 scatter = square - sum * sum / n;
  return glm::max(scatter, glm::dvec3(0)) / (static_cast<double>(blocks_of(index) - 1) * n);
}

double FilmBuffer::relative_error() const {
  if (!has_variance()) return 0;
  const glm::dvec3 luminance(0.212671, 0.715160, 0.072169);
  const auto sum_over = [&](size_t first, size_t last) {  // luminance and its variance
    glm::dvec2 sum(0);
    for (size_t i = first; i < last; ++i) {
      const double deviation = glm::dot(luminance, glm::sqrt(variance_of_mean(i)));
      sum += glm::dvec2(glm::dot(luminance, mean(i)), deviation * deviation);
    }
    return sum;
  };
  const glm::dvec2 all =
      parallel_reduce<glm::dvec2>(0, pixels(), sum_over, std::plus()) / static_cast<double>(pixels());
  return all.x > 0 ? std::sqrt(all.y) / all.x : 0;
}

std::vector<FilmBuffer::NamedSums> FilmBuffer::all_sums() {
  std::vector<NamedSums> all;
  for (size_t c = 0; c < 3; ++c) all.push_back({sum_name(kColors[c]), &sums_[c]});
  for (size_t c = 0; c < 3; ++c) all.push_back({std::string(kSquaresLayer) + kColors[c], &squares_[c]});
  for (size_t c = 0; c < extra_.size(); ++c) all.push_back({sum_name(extra_names_[c]), &extra_[c]});
  return all;
}

Image FilmBuffer::to_image(bool sums) const {
  Image image;
  image.width = width_;
  image.height = height_;
  const auto add = [&](const std::string& name, const auto& value) {
    std::vector<float>& channel = image.add(name);
    parallel_for(0, channel.size(), kPixelsAtOnce, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) channel[i] = static_cast<float>(value(i));
    });
  };
  for (glm::length_t c = 0; c < 3; ++c) add(kColors[c], [&](size_t i) { return mean(i)[c]; });
  if (has_variance())
    for (glm::length_t c = 0; c < 3; ++c)
      add(std::string("variance.") + kColors[c], [&](size_t i) { return variance_of_mean(i)[c]; });
  for (size_t c = 0; c < extra_.size(); ++c)
    add(extra_names_[c], [&](size_t i) { return extra_mean(i, c); });
  const auto count = [&](size_t i) { return samples_of(i); };
  if (!count_channel_.empty()) add(count_channel_, count);
  if (is_adaptive()) add("samples", count);
  if (!sums) return image;
  CHECK(!is_adaptive());

  for (const NamedSums& named : const_cast<FilmBuffer*>(this)->all_sums())
    for (size_t w = 0; w < 4; ++w) {
      std::vector<uint32_t>& channel = image.add_words(word_channel(named.name, w));
      for (size_t i = 0; i < pixels(); ++i) channel[i] = named.sums->words(i)[w];
    }
  image.metadata[kRangesKey] = format_ranges(ranges_);
  image.metadata[kBlocksKey] = fmt::format("{}", blocks_);
  if (!count_channel_.empty()) image.metadata[kCountKey] = count_channel_;
  return image;
}

FilmBuffer FilmBuffer::from_image(const Image& image, const std::string& place) {
  const auto attribute = [&](const char* key) -> std::string_view {
    const auto found = image.metadata.find(key);
    if (found == image.metadata.end())
      throw InputError(fmt::format("{}: has no attribute {}: it was not written by render or reference, or with --no-sums "
                                   "or --adaptive",
                                   place, key));
    return found->second;
  };
  const std::vector<SampleRange> ranges = parse_ranges(attribute(kRangesKey));
  std::string_view text = attribute(kBlocksKey);
  uint64_t blocks = 0;
  if (ranges.empty()) throw InputError(fmt::format("{}: broken attribute {}", place, kRangesKey));
  uint64_t samples = 0;
  for (const SampleRange& range : ranges) samples += range.count;
  if (!take_number(text, blocks) || !text.empty() || blocks == 0 || blocks > samples ||
      blocks > ReproducibleSums::kMaxValues)
    throw InputError(fmt::format("{}: broken attribute {}", place, kBlocksKey));

  // Every channel but the colours that has sums is an extra one.
  std::vector<std::string> extra;
  for (const std::string& name : image.names)
    if (image.find_words(word_channel(sum_name(name), 0)) && name != "R" && name != "G" && name != "B")
      extra.push_back(name);
  const auto count_channel = image.metadata.find(kCountKey);
  FilmBuffer film(image.width, image.height, extra,
                  count_channel == image.metadata.end() ? std::string() : count_channel->second);
  for (const NamedSums& named : film.all_sums()) {
    const std::vector<uint32_t>* words[4];
    for (size_t w = 0; w < 4; ++w) {
      words[w] = image.find_words(word_channel(named.name, w));
      if (!words[w])
        throw InputError(fmt::format("{}: lacks the channel {}", place, word_channel(named.name, w)));
    }
    for (size_t i = 0; i < film.pixels(); ++i)
      if (!named.sums->set_words(i, {(*words[0])[i], (*words[1])[i], (*words[2])[i], (*words[3])[i]}))
        throw InputError(fmt::format("{}: the words {} are broken", place, named.name));
  }
  film.ranges_ = ranges;
  film.blocks_ = blocks;
  return film;
}

}  // namespace tachylite
