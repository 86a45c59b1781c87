#pragma once

// A scene as a tree of XML elements and the files that they name: what random_scene makes and minimise_scene prunes.

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace tachylite::test {

struct Element {
  std::string tag;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<Element> children;

  Element& add(Element child) {
    children.push_back(std::move(child));
    return *this;
  }
  const std::string* attribute(std::string_view name) const;
};

/// <tag type="plugin">
Element plugin(const std::string& tag, const std::string& type);
/// The same as a parameter of that name.
Element plugin(const std::string& tag, const std::string& name, const std::string& type);
/// <tag name="name" value="value"/>
Element parameter(const std::string& tag, const std::string& name, const std::string& value);
inline Element real(const std::string& name, double value) {
  return parameter("float", name, fmt::format("{:.6g}", value));
}
inline Element integer(const std::string& name, int value) { return parameter("integer", name, std::to_string(value)); }
inline Element boolean(const std::string& name, bool value) {
  return parameter("boolean", name, value ? "true" : "false");
}
inline Element word(const std::string& name, const std::string& value) { return parameter("string", name, value); }

struct SceneText {
  std::vector<Element> elements;                            // inside <scene>
  std::vector<std::pair<std::string, std::string>> files;  // name, content
  /// The elements, a line each.
  std::string xml() const;
};

}  // namespace tachylite::test
