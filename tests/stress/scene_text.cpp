#include "stress/scene_text.h"

namespace tachylite::test {
namespace {

void write(const Element& element, int depth, std::string& out) {
  out.append(static_cast<size_t>(2 * depth), ' ').append("<").append(element.tag);
  for (const auto& [name, value] : element.attributes) out += fmt::format(" {}=\"{}\"", name, value);
  if (element.children.empty()) {
    out += "/>\n";
    return;
  }
  out += ">\n";
  for (const Element& child : element.children) write(child, depth + 1, out);
  out.append(static_cast<size_t>(2 * depth), ' ').append("</").append(element.tag).append(">\n");
}

}  // namespace

const std::string* Element::attribute(std::string_view name) const {
  for (const auto& [key, value] : attributes)
    if (key == name) return &value;
  return nullptr;
}

Element plugin(const std::string& tag, const std::string& type) { return {tag, {{"type", type}}, {}}; }

Element plugin(const std::string& tag, const std::string& name, const std::string& type) {
  return {tag, {{"name", name}, {"type", type}}, {}};
}

Element parameter(const std::string& tag, const std::string& name, const std::string& value) {
  return {tag, {{"name", name}, {"value", value}}, {}};
}

std::string SceneText::xml() const {
  std::string out;
  for (const Element& element : elements) write(element, 1, out);
  return out;
}

}  // namespace tachylite::test
