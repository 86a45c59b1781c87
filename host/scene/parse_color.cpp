#include "scene/parse_color.h"

#include <charconv>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/read_file.h"
#include "scene/parse_value.h"
#include "scene/plugin.h"
#include "scene/text_cursor.h"

namespace tachylite {
namespace {

[[noreturn]] void fail(const XmlNode& node, const std::string& owner, const std::string& expected) {
  throw InputError(node.where, fmt::format("{} of {} is \"{}\", expected {}", node.name(), owner,
                                           node.attribute("value"), expected));
}

/// One or three numbers.
dvec3 parse_triple(const XmlNode& node, const std::string& owner) {
  const auto values = parse_reals(node.attribute("value"));
  if (!values || (values->size() != 1 && values->size() != 3)) fail(node, owner, "one or three numbers");
  return values->size() == 1 ? dvec3((*values)[0]) : dvec3((*values)[0], (*values)[1], (*values)[2]);
}

/// "#rrggbb" or three numbers, sRGB encoded (Mitsuba 0.6).
dvec3 parse_srgb(const XmlNode& node, const std::string& owner) {
  dvec3 encoded;
  if (const std::string& text = node.attribute("value"); text.starts_with('#')) {
    uint32_t hex = 0;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), hex, 16);
    if (text.size() != 7 || error != std::errc() || end != text.data() + 7) fail(node, owner, "#rrggbb");
    encoded = dvec3(hex >> 16, (hex >> 8) & 255, hex & 255) / 255.0;
  } else {
    encoded = parse_triple(node, owner);
  }
  dvec3 linear;
  for (int c = 0; c < 3; ++c)
    linear[c] = encoded[c] <= 0.04045 ? encoded[c] / 12.92 : std::pow((encoded[c] + 0.055) / 1.055, 2.4);
  return linear;
}

/// Samples that are added one by one, then integrated.
class Samples {
 public:
  /// False when the wavelength does not rise or the value is negative.
  bool add(double wavelength, double value) {
    if (value < 0 || (!wavelengths_.empty() && wavelength <= wavelengths_.back())) return false;
    wavelengths_.push_back(wavelength);
    values_.push_back(value);
    return true;
  }
  size_t size() const { return values_.size(); }
  dvec3 rgb(ColorUse use) const { return spectrum_to_rgb(wavelengths_, values_, use); }

 private:
  std::vector<double> wavelengths_, values_;
};

dvec3 parse_pairs(const XmlNode& node, const std::string& owner, const std::vector<std::string_view>& pairs,
                  ColorUse use) {
  Samples samples;
  for (const std::string_view pair : pairs) {
    const size_t colon = pair.find(':');
    const auto wavelength = parse_real(pair.substr(0, colon));
    const auto value = colon == pair.npos ? std::nullopt : parse_real(pair.substr(colon + 1));
    if (!wavelength || !value) fail(node, owner, "one number or pairs of wavelength:value");
    if (!samples.add(*wavelength, *value)) fail(node, owner, "wavelengths that rise and no negative values");
  }
  if (samples.size() < 2) fail(node, owner, "at least two pairs of wavelength:value");
  return samples.rgb(use);
}

/// A wavelength [nm] and a value on each line; # starts a comment.
dvec3 read_spectrum_file(const std::filesystem::path& file, ColorUse use) {
  const FileBytes bytes = read_file(file, uint64_t{1} << 24);
  Samples samples;
  for (TextCursor cursor(bytes.view(), locate_file(file)); !cursor.at_end(); cursor.skip_line()) {
    if (cursor.at_line_end() || cursor.rest().starts_with('#')) continue;
    const float wavelength = cursor.real("wavelength");
    if (!samples.add(wavelength, cursor.real("value")))
      cursor.fail("expected wavelengths that rise and no negative values");
    if (!cursor.at_line_end()) cursor.fail("expected a wavelength and a value on each line");
  }
  if (samples.size() < 2) throw InputError(locate_file(file), "the spectrum has less than two samples");
  return samples.rgb(use);
}

/// <spectrum type="srgb"> ..., as far as they mean something without wavelengths.
dvec3 parse_spectrum_plugin(SceneLoader& loader, const XmlNode& node, ColorUse use) {
  const SceneLoader::Nesting nesting(loader, node);
  const Plugin plugin(loader, node);
  dvec3 color(0);
  if (plugin.type() == "srgb") {
    color = plugin.constant_color("color", color, use);
  } else if (plugin.type() == "uniform") {
    color = dvec3(plugin.real("value", 1));
  } else if (plugin.type() == "d65") {
    color = plugin.constant_color("color", dvec3(1), ColorUse::kEmission) * plugin.real("scale", 1);
  } else {
    throw InputError(node.where, fmt::format("the spectrum plugin {} is not supported", node.type()));
  }
  plugin.finish();
  return color;
}

dvec3 parse_spectrum(SceneLoader& loader, const XmlNode& node, const std::string& owner, ColorUse use) {
  if (node.has("type")) return parse_spectrum_plugin(loader, node, use);
  if (node.has("filename")) {
    if (node.has("value")) fail(node, owner, "either value or filename");
    return read_spectrum_file(loader.find_file(node, node.attribute("filename")), use);
  }
  const auto parts = split_list(node.attribute("value"));
  if (parts.empty()) fail(node, owner, "one number or pairs of wavelength:value");
  if (parts[0].find(':') != std::string_view::npos) return parse_pairs(node, owner, parts, use);
  if (node.legacy && parts.size() == 3) return parse_triple(node, owner);  // 0.6 as compiled for RGB
  if (parts.size() != 1) fail(node, owner, "one number or pairs of wavelength:value");
  const dvec3 constant = parse_triple(node, owner);
  return use == ColorUse::kEmission && !node.legacy ? xyz_to_rgb(constant) : constant;
}

}  // namespace

double luminance(const dvec3& rgb) {
  return glm::dot(rgb, dvec3(.212671, .715160, .072169));
}

dvec3 parse_color(SceneLoader& loader, const XmlNode& node, const std::string& owner, ColorUse use) {
  dvec3 color;
  if (node.tag == "float" || node.tag == "integer") {
    const auto value = parse_real(node.attribute("value"));
    if (!value) fail(node, owner, "a number");
    color = dvec3(*value);
  } else if (node.tag == "rgb") {
    color = parse_triple(node, owner);
  } else if (node.tag == "srgb") {
    color = parse_srgb(node, owner);
  } else if (node.tag == "spectrum") {
    color = parse_spectrum(loader, node, owner, use);
  } else {
    throw InputError(node.where, fmt::format("{} of {} is a <{}>, expected a colour or a texture",
                                             node.name(), owner, node.tag));
  }
  if (!node.children.empty() && !node.has("type"))
    throw InputError(node.children.front().where, fmt::format("<{}> cannot hold other elements", node.tag));
  for (int c = 0; c < 3; ++c) {
    if (color[c] < 0) fail(node, owner, "no negative values");
    if (!(color[c] <= std::numeric_limits<float>::max())) fail(node, owner, "values that a float can hold");
    if (use == ColorUse::kReflectance && color[c] > 1) fail(node, owner, "values within [0, 1]");
  }
  return color;
}

}  // namespace tachylite
