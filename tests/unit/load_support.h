#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/load_xml.h"

namespace tachylite {

/// A folder of its own for each test, removed at its end.
class LoadTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name =
        std::string(info->test_suite_name()) + "." + info->name() + "." + std::to_string(getpid());
    for (char& c : name)
      if (c == '/') c = '_';
    folder_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, std::string_view content) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  Scene load(std::string_view xml, const LoadOptions& options = {}) const {
    return load_scene(write("scene.xml", xml), options);
  }
  /// The body in a scene with a sensor and an emitter, on one line.
  Scene load_body(std::string_view body, const std::string& version = "3.0.0") const {
    return load("<scene version=\"" + version +
                "\"><sensor type=\"perspective\"/><emitter type=\"constant\"/>" + std::string(body) +
                "</scene>");
  }
  /// What load() complains about, without the folder; "" when it does not.
  std::string complaint(std::string_view xml, const LoadOptions& options = {}) const {
    try {
      load(xml, options);
      return "";
    } catch (const InputError& error) {
      std::string message = error.what();
      const std::string prefix = folder_.string() + "/";
      if (message.starts_with(prefix)) message.erase(0, prefix.size());
      return message;
    }
  }

  std::filesystem::path folder_;
};

/// The only bsdf, texture... of that kind.
template <typename Kind, typename Objects>
const Kind& only(const Objects& objects) {
  const Kind* found = nullptr;
  for (const auto& object : objects)
    if (const auto* kind = std::get_if<Kind>(&object.kind)) {
      EXPECT_EQ(found, nullptr) << "several objects of the kind";
      found = kind;
    }
  if (!found) throw std::logic_error("no object of the kind");
  return *found;
}

inline void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

}  // namespace tachylite
