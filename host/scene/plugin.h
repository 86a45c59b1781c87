#pragma once

#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "scene/parse_spectrum.h"
#include "scene/scene_loader.h"

namespace tachylite {

/// Closed range of allowed values; open_low excludes the lower end.
struct Range {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool open_low = false, open_high = false;
};
constexpr Range kAny{};
constexpr Range kUnit{0, 1};
constexpr Range kNotNegative{0};
constexpr Range kPositive{0, std::numeric_limits<double>::infinity(), true};

/// The parameters of one plugin element (<bsdf type="diffuse"> ...). Each reader takes what it knows by name,
/// and finish() refuses what is left. All throw InputError with the line of the offending element.
class Plugin {
 public:
  Plugin(SceneLoader& loader, const XmlNode& node);

  SceneLoader& loader() const { return loader_; }
  const XmlNode& node() const { return node_; }
  const std::string& type() const { return node_.type(); }
  const FileLocation& where() const { return node_.where; }
  bool has(std::string_view name) const { return find(name) != nullptr; }
  bool is_string(std::string_view name) const;
  bool is_color(std::string_view name) const;  // <rgb> or <spectrum>, against <float>
  const FileLocation& where(
      std::string_view name) const;  // of the parameter, or of the plugin when not given

  double real(std::string_view name, double absent, Range range = kAny) const;
  int integer(std::string_view name, int absent, int low, int high = std::numeric_limits<int>::max()) const;
  bool boolean(std::string_view name, bool absent) const;
  std::string string(std::string_view name, const std::string& absent) const;
  /// One of the words, or an error that names them.
  std::string word(std::string_view name, const std::string& absent,
                   std::initializer_list<const char*> words) const;
  dvec3 vector(std::string_view name, const dvec3& absent) const;
  dmat4 transform(std::string_view name) const;  // identity when not given

  /// A number, colour, spectrum or texture.
  ColorInput color(std::string_view name, const ColorInput& absent, ColorUse use) const;
  ScalarInput scalar(std::string_view name, const ScalarInput& absent, Range range) const;
  /// The same without textures.
  dvec3 constant_color(std::string_view name, const dvec3& absent, ColorUse use) const;

  /// The child of that name, whatever it is; null when not given.
  const XmlNode* take(std::string_view name) const;

  /// Required string; the file exists.
  std::filesystem::path file(std::string_view name) const;

  /// Nested objects of that tag, given in place or by <ref>, in document order.
  std::vector<const XmlNode*> objects(std::string_view tag) const;
  /// The only nested object of that tag; null if there is none, an error if there are several.
  const XmlNode* object(std::string_view tag) const;

  /// Parameters that mean nothing for the image as it is computed here.
  void ignore(std::initializer_list<std::string_view> names) const;

  /// Refuses everything that was not read.
  void finish() const;

  [[noreturn]] void fail(std::string_view name, const std::string& expected) const;

 private:
  const XmlNode* find(std::string_view name) const;
  const XmlNode* find_value(std::string_view name, std::initializer_list<std::string_view> tags) const;
  dvec3 color_value(const XmlNode& child, ColorUse use) const;

  SceneLoader& loader_;
  const XmlNode& node_;
};

}  // namespace tachylite
