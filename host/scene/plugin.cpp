#include "scene/plugin.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "scene/parse_color.h"
#include "scene/parse_transform.h"
#include "scene/parse_value.h"

namespace tachylite {
namespace {

bool is_object_tag(std::string_view tag) {
  constexpr std::string_view kTags[] = {"bsdf",   "shape",  "texture", "emitter", "medium",  "phase",
                                        "volume", "sensor", "sampler", "film",    "rfilter", "integrator"};
  return std::find(std::begin(kTags), std::end(kTags), tag) != std::end(kTags);
}

std::string describe(Range range) {
  const bool low = range.low != kAny.low, high = range.high != kAny.high;
  if (low && high)
    return fmt::format("within {}{}, {}{}", range.open_low ? '(' : '[', range.low, range.high,
                       range.open_high ? ')' : ']');
  if (low) return fmt::format("{} {}", range.open_low ? "above" : "at least", range.low);
  return fmt::format("{} {}", range.open_high ? "below" : "at most", range.high);
}

bool contains(Range range, double value) {
  return (range.open_low ? value > range.low : value >= range.low) &&
         (range.open_high ? value < range.high : value <= range.high);
}

}  // namespace

Plugin::Plugin(SceneLoader& loader, const XmlNode& node) : loader_(loader), node_(node) {
  node.used = true;
  // A name that is given twice could mean either, unless objects of different kinds bear it.
  std::set<std::string_view> names;
  std::set<std::pair<std::string_view, std::string_view>> objects_of;
  for (const XmlNode& child : node.children) {
    if (!child.known || child.name().empty()) continue;
    const bool new_name = names.insert(child.name()).second;
    const bool new_object = objects_of.emplace(child.name(), child.tag).second;
    if (!(is_object_tag(child.tag) ? new_object : new_name))
      throw InputError(child.where, fmt::format("{} has the parameter {} twice", type(), child.name()));
  }
}

const XmlNode* Plugin::find(std::string_view name) const {
  for (const XmlNode& child : node_.children)
    if (child.known && child.name() == name) return &child;
  return nullptr;
}

bool Plugin::is_string(std::string_view name) const {
  const XmlNode* child = find(name);
  return child && child->tag == "string";
}

bool Plugin::is_color(std::string_view name) const {
  const XmlNode* child = find(name);
  return child && (child->tag == "rgb" || child->tag == "srgb" || child->tag == "spectrum");
}

const XmlNode* Plugin::take(std::string_view name) const {
  const XmlNode* child = find(name);
  if (child) child->used = true;
  return child;
}

const FileLocation& Plugin::where(std::string_view name) const {
  const XmlNode* child = find(name);
  return child ? child->where : node_.where;
}

void Plugin::fail(std::string_view name, const std::string& expected) const {
  const XmlNode* child = find(name);
  if (!child)
    throw InputError(node_.where,
                     fmt::format("{} lacks the parameter {}, expected {}", type(), name, expected));
  throw InputError(child->where, fmt::format("{} of {} is \"{}\", expected {}", name, type(),
                                             child->attribute("value"), expected));
}

const XmlNode* Plugin::find_value(std::string_view name, std::initializer_list<std::string_view> tags) const {
  const XmlNode* child = find(name);
  if (!child) return nullptr;
  if (std::find(tags.begin(), tags.end(), child->tag) == tags.end())
    throw InputError(child->where, fmt::format("{} of {} is a <{}>, expected <{}>", name, type(), child->tag,
                                               *tags.begin()));
  child->used = true;
  if (!child->children.empty())
    throw InputError(child->children.front().where,
                     fmt::format("<{}> cannot hold other elements", child->tag));
  return child;
}

double Plugin::real(std::string_view name, double absent, Range range) const {
  const XmlNode* child = find_value(name, {"float", "integer"});
  if (!child) return absent;
  const auto value = parse_real(child->attribute("value"));
  if (!value) fail(name, "a number");
  if (!contains(range, *value)) fail(name, describe(range));
  return *value;
}

int Plugin::integer(std::string_view name, int absent, int low, int high) const {
  const XmlNode* child = find_value(name, {"integer"});
  if (!child) return absent;
  const auto value = parse_integer(child->attribute("value"));
  if (!value) fail(name, "a whole number");
  if (*value < low || *value > high)
    fail(name, high == std::numeric_limits<int>::max() ? fmt::format("at least {}", low)
                                                       : fmt::format("within [{}, {}]", low, high));
  return static_cast<int>(*value);
}

bool Plugin::boolean(std::string_view name, bool absent) const {
  const XmlNode* child = find_value(name, {"boolean"});
  if (!child) return absent;
  const auto value = parse_boolean(child->attribute("value"));
  if (!value) fail(name, "true or false");
  return *value;
}

std::string Plugin::string(std::string_view name, const std::string& absent) const {
  const XmlNode* child = find_value(name, {"string"});
  return child ? child->attribute("value") : absent;
}

std::string Plugin::word(std::string_view name, const std::string& absent,
                         std::initializer_list<const char*> words) const {
  std::string value = string(name, absent);
  std::transform(value.begin(), value.end(), value.begin(), [](unsigned char c) { return std::tolower(c); });
  if (std::find(words.begin(), words.end(), value) == words.end())
    fail(name, fmt::format("one of: {}", fmt::join(words.begin(), words.end(), ", ")));
  return value;
}

dvec3 Plugin::vector(std::string_view name, const dvec3& absent) const {
  const XmlNode* child = find_value(name, {"point", "vector"});
  return child ? parse_vector(*child) : absent;
}

dmat4 Plugin::transform(std::string_view name) const {
  const XmlNode* child = find(name);
  if (!child) return dmat4(1);
  if (child->tag != "transform")
    throw InputError(child->where,
                     fmt::format("{} of {} is a <{}>, expected <transform>", name, type(), child->tag));
  child->used = true;
  return parse_transform(*child);
}

ColorInput Plugin::color(std::string_view name, const ColorInput& absent, ColorUse use) const {
  const XmlNode* child = find(name);
  if (!child) return absent;
  child->used = true;
  const XmlNode& target = loader_.resolve(*child);
  if (target.tag != "texture") return parse_color(loader_, target, type(), use);
  ColorInput input;
  input.texture = loader_.texture(target);
  return input;
}

ScalarInput Plugin::scalar(std::string_view name, const ScalarInput& absent, Range range) const {
  const XmlNode* child = find(name);
  if (!child) return absent;
  if (child->tag == "float" || child->tag == "integer") return real(name, 0, range);
  child->used = true;
  const XmlNode& target = loader_.resolve(*child);
  ScalarInput input;
  if (target.tag == "texture") {
    input.texture = loader_.texture(target);
  } else {
    input.value = luminance(parse_color(loader_, target, type(), ColorUse::kIor));
    if (!contains(range, input.value)) fail(name, describe(range));
  }
  return input;
}

dvec3 Plugin::constant_color(std::string_view name, const dvec3& absent, ColorUse use) const {
  const ColorInput input = color(name, absent, use);
  if (input.texture != kNone)
    throw InputError(where(name),
                     fmt::format("{} of {} is a texture, which is not supported here", name, type()));
  return input.value;
}

std::filesystem::path Plugin::file(std::string_view name) const {
  const XmlNode* child = find_value(name, {"string"});
  if (!child || child->attribute("value").empty()) fail(name, "the name of a file");
  return loader_.find_file(*child, child->attribute("value"));
}

std::vector<const XmlNode*> Plugin::objects(std::string_view tag) const {
  std::vector<const XmlNode*> found;
  for (const XmlNode& child : node_.children) {
    if (child.tag != tag && child.tag != "ref") continue;
    const XmlNode& target = loader_.resolve(child);
    if (target.tag != tag) continue;
    child.used = true;
    found.push_back(&target);
  }
  return found;
}

const XmlNode* Plugin::object(std::string_view tag) const {
  const auto found = objects(tag);
  if (found.size() > 1)
    throw InputError(found[1]->where, fmt::format("{} has several <{}>, expected one", type(), tag));
  return found.empty() ? nullptr : found[0];
}

void Plugin::ignore(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names)
    if (const XmlNode* child = find(name)) child->used = true;
}

void Plugin::finish() const {
  for (const XmlNode& child : node_.children) {
    if (child.used) continue;
    if (child.known && !child.name().empty())
      loader_.refuse(child.where, fmt::format("{} has no parameter {}", type(), child.name()));
    else
      loader_.refuse(child.where, fmt::format("<{}> means nothing inside {}", child.tag, type()));
  }
}

}  // namespace tachylite
