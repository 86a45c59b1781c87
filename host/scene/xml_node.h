#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/file_location.h"

namespace tachylite {

/// An element of the scene description after includes are spliced in, $names replaced and names of parameters
/// brought to the spelling of Mitsuba 3 (toWorld -> to_world).
struct XmlNode {
  std::string tag;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<XmlNode> children;
  FileLocation where;
  bool known = false;         // the tag is one of the format's
  bool legacy = false;        // from a file of version 0.x: Mitsuba 0.6 decides what it means
  mutable bool used = false;  // somebody has read it; what nobody reads is an error

  /// The attribute's value, or "".
  const std::string& attribute(std::string_view name) const;
  bool has(std::string_view name) const;
  const std::string& name() const { return attribute("name"); }
  const std::string& type() const { return attribute("type"); }
  const std::string& id() const { return attribute("id"); }
};

struct XmlTree {
  XmlNode root;                                       // the element <scene>
  std::vector<std::filesystem::path> search_folders;  // of <path>, the last one first
  std::map<std::string, std::string> aliases;         // <alias id="target" as="name">: name -> target
};

/// Reads the file and all it includes. `parameters` win over the scene's <default>s; one that the scene does
/// not mention is an error, and so is a $name without a value. Throws InputError; line numbers are those of
/// the element's first line.
XmlTree read_xml(const std::filesystem::path& file, const std::map<std::string, std::string>& parameters);

}  // namespace tachylite
