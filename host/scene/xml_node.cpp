#include "scene/xml_node.h"

#include <algorithm>
#include <cctype>
#include <set>

#include <pugixml.hpp>

#include "base/error.h"
#include "base/memory.h"
#include "base/read_file.h"
#include "scene/parse_value.h"

namespace tachylite {
namespace {

constexpr int kMaxDepth = 64;            // of nested elements
constexpr size_t kMaxIncludeDepth = 16;  // of nested files
constexpr size_t kMaxFiles = 1000, kMaxFolders = 1000;
constexpr uint64_t kMaxBytes = uint64_t{1} << 30;      // of all files together
constexpr size_t kMaxSubstituted = size_t{1} << 26;  // characters that stand for $names, in all

struct Attributes {
  std::set<std::string_view> allowed;
  std::set<std::string_view> required;
};

/// Elements of the format. Objects name a plugin by `type`.
const Attributes* find_attributes(std::string_view tag) {
  static const Attributes object{{"type", "id", "name", "version"},
                                 {"type"}};  // version: as root of an include
  static const Attributes value{{"name", "value"}, {"name", "value"}};
  static const Attributes color{{"name", "value", "intent"}, {"name", "value"}};
  static const Attributes vector{{"name", "value", "x", "y", "z"}, {"name"}};
  static const Attributes operation{{"value", "x", "y", "z"}, {}};
  static const std::map<std::string_view, Attributes> table{
      {"scene", {{"version"}, {}}},
      {"bsdf", object},
      {"shape", object},
      {"texture", object},
      {"emitter", object},
      {"medium", object},
      {"phase", object},
      {"volume", object},
      {"sensor", object},
      {"film", object},
      {"rfilter", object},
      {"sampler", object},
      {"integrator", object},
      {"subsurface", object},
      {"boolean", value},
      {"integer", value},
      {"float", value},
      {"string", value},
      {"rgb", color},
      {"srgb", color},
      {"spectrum", {{"name", "value", "filename", "type", "id", "intent"}, {"name"}}},
      {"blackbody", {{"name", "temperature", "scale"}, {"name"}}},
      {"point", vector},
      {"vector", vector},
      {"transform", {{"name"}, {"name"}}},
      {"translate", operation},
      {"scale", operation},
      {"rotate", {{"value", "x", "y", "z", "angle"}, {"angle"}}},
      {"lookat", {{"origin", "target", "up"}, {"origin", "target"}}},
      {"matrix", {{"value"}, {"value"}}},
      {"ref", {{"id", "name"}, {"id"}}},
      {"include", {{"filename"}, {"filename"}}},
      {"path", {{"value"}, {"value"}}},
      {"alias", {{"id", "as"}, {"id", "as"}}},
      {"default", {{"name", "value"}, {"name", "value"}}},
  };
  const auto found = table.find(tag);
  return found == table.end() ? nullptr : &found->second;
}

/// toWorld -> to_world, intIOR -> int_ior; what is in small letters stays as it is.
std::string to_snake_case(const std::string& name) {
  std::string snake;
  for (size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    if (i > 0 && std::isupper(c) && std::islower(static_cast<unsigned char>(name[i - 1]))) snake += '_';
    snake += i > 0 ? static_cast<char>(std::tolower(c)) : name[i];
  }
  return snake;
}

std::string to_lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

class Reader {
 public:
  explicit Reader(const std::map<std::string, std::string>& parameters) : parameters_(parameters) {}

  XmlTree read(const std::filesystem::path& file) {
    tree_.root.tag = "scene";
    scene_folder_ = file.parent_path();
    read_file_into(file, locate_file(file), tree_.root);
    for (const auto& [name, value] : parameters_)
      if (!mentioned_.contains(name))
        throw InputError(locate_file(file),
                         fmt::format("the scene has no parameter ${} to set to \"{}\"", name, value));
    return std::move(tree_);
  }

 private:
  /// One file: its text for line numbers, and the generation of Mitsuba it was written for.
  struct Source {
    std::shared_ptr<const std::string> name;
    std::vector<ptrdiff_t> line_starts;
    bool legacy = false;

    FileLocation at(ptrdiff_t offset) const {
      const auto after = std::upper_bound(line_starts.begin(), line_starts.end(), offset);
      return {name, static_cast<int>(after - line_starts.begin())};
    }
  };

  void read_file_into(const std::filesystem::path& file, const FileLocation& asked_at, XmlNode& parent) {
    // Guard against endless inclusion.
    std::error_code failed;
    const std::filesystem::path canonical = std::filesystem::weakly_canonical(file, failed);
    if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
      throw InputError(asked_at, fmt::format("{} includes itself", file.string()));
    if (open_files_.size() >= kMaxIncludeDepth)
      throw InputError(asked_at, fmt::format("files are included more than {} deep", kMaxIncludeDepth));
    open_files_.push_back(canonical);

    // Parse it and note where lines start.
    if (++files_ > kMaxFiles) throw InputError(asked_at, fmt::format("more than {} files are included", kMaxFiles));
    const FileBytes bytes = read_file(file, kMaxBytes - bytes_);
    bytes_ += bytes.size;
    constexpr uint64_t kBytesOfElement = 450;  // here and in the parser
    require_memory(asked_at, "the scene's text", kBytesOfElement * std::count(bytes.view().begin(), bytes.view().end(), '<'));
    Source source{std::make_shared<const std::string>(file.string()), {0}};
    for (size_t i = 0; i < bytes.size; ++i)
      if (bytes.data[i] == '\n') source.line_starts.push_back(static_cast<ptrdiff_t>(i) + 1);
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(bytes.data.get(), bytes.size);
    if (!parsed)
      throw InputError(source.at(parsed.offset), fmt::format("broken XML: {}", parsed.description()));

    const pugi::xml_node root = document.document_element();
    if (root.next_sibling())
      throw InputError(source.at(root.next_sibling().offset_debug()), "only one root element is allowed");
    const bool is_scene = root.name() == std::string_view("scene");
    if (!is_scene && open_files_.size() == 1)
      throw InputError(source.at(root.offset_debug()),
                       fmt::format("the root element is <{}>, expected <scene>", root.name()));
    read_version(root, source, parent.legacy);
    if (is_scene) {
      if (open_files_.size() == 1)
        tree_.root = {"scene", {}, {}, source.at(root.offset_debug()), true, source.legacy};
      check_attributes(root, source.at(root.offset_debug()));
      XmlNode& into = open_files_.size() == 1 ? tree_.root : parent;
      for (const pugi::xml_node child : root.children()) read_element(child, source, into, 1);
    } else {
      read_element(root, source, parent, 1);
    }
    open_files_.pop_back();
  }

  void read_version(const pugi::xml_node& root, Source& source, bool inherited) {
    const FileLocation where = source.at(root.offset_debug());
    const std::string_view version = root.attribute("version").value();
    if (version.empty()) {
      if (open_files_.size() == 1)
        throw InputError(where, "<scene> has no version, expected e.g. version=\"3.0.0\"");
      source.legacy = inherited;
      return;
    }
    const auto major = parse_integer(version.substr(0, version.find('.')));
    if (!major || (*major != 0 && *major != 2 && *major != 3))
      throw InputError(
          where, fmt::format("scene version \"{}\" is not supported, expected 3.x, 2.x or 0.6", version));
    source.legacy = *major == 0;
  }

  void read_element(const pugi::xml_node& element, const Source& source, XmlNode& parent, int depth) {
    if (element.type() == pugi::node_pcdata || element.type() == pugi::node_cdata) {
      std::string_view text = element.value();
      const size_t blank = std::min(text.find_first_not_of(" \t\r\n"), text.size());
      text.remove_prefix(blank);
      throw InputError(source.at(element.offset_debug() + static_cast<ptrdiff_t>(blank)),
                       fmt::format("stray text \"{:.30}\"", text));
    }
    const FileLocation where = source.at(element.offset_debug());
    if (element.type() != pugi::node_element) return;
    if (depth > kMaxDepth)
      throw InputError(where, fmt::format("elements are nested more than {} deep", kMaxDepth));

    XmlNode node{element.name(), {}, {}, where, false, source.legacy};
    if (node.tag == "lookAt") node.tag = "lookat";
    node.known = find_attributes(node.tag) != nullptr;
    check_attributes(element, where);
    for (const pugi::xml_attribute attribute : element.attributes())
      node.attributes.emplace_back(attribute.name(), substitute(attribute.value(), where));
    for (auto& [name, value] : node.attributes) {
      if (name == "name" && node.tag != "default") value = to_snake_case(value);
      if (name == "type") value = to_lower_case(value);
    }

    if (node.tag == "include") {
      const std::string& name = node.attribute("filename");
      const auto file = find_file(name, source);
      if (!file) throw InputError(where, fmt::format("included file \"{}\" does not exist", name));
      read_file_into(*file, where, parent);
    } else if (node.tag == "default") {
      mentioned_.insert(node.name());
      parameters_.emplace(node.name(), node.attribute("value"));
    } else if (node.tag == "path") {
      const auto folder = find_file(node.attribute("value"), source);
      if (!folder || !std::filesystem::is_directory(*folder))
        throw InputError(where, fmt::format("folder \"{}\" does not exist", node.attribute("value")));
      if (tree_.search_folders.size() >= kMaxFolders)
        throw InputError(where, fmt::format("more than {} <path>", kMaxFolders));
      tree_.search_folders.insert(tree_.search_folders.begin(), *folder);
    } else if (node.tag == "alias") {
      if (!tree_.aliases.emplace(node.attribute("as"), node.id()).second)
        throw InputError(where, fmt::format("id \"{}\" is given twice", node.attribute("as")));
    } else {
      for (const pugi::xml_node child : element.children()) read_element(child, source, node, depth + 1);
      parent.children.push_back(std::move(node));
      return;
    }
    if (element.first_child())
      throw InputError(where, fmt::format("<{}> cannot hold other elements", node.tag));
  }

  /// Folders of <path>, then the folder of the file that asks, then that of the scene.
  std::optional<std::filesystem::path> find_file(const std::string& name, const Source& source) const {
    std::error_code failed;
    if (std::filesystem::path(name).is_absolute())
      return std::filesystem::exists(name, failed) ? std::optional(std::filesystem::path(name))
                                                   : std::nullopt;
    std::vector<std::filesystem::path> folders = tree_.search_folders;
    folders.push_back(std::filesystem::path(*source.name).parent_path());
    folders.push_back(scene_folder_);
    for (const auto& folder : folders)
      if (std::filesystem::exists(folder / name, failed)) return folder / name;
    return std::nullopt;
  }

  void check_attributes(const pugi::xml_node& element, const FileLocation& where) const {
    std::string_view tag = element.name();
    if (tag == "lookAt") tag = "lookat";
    const Attributes* known = find_attributes(tag);
    std::set<std::string_view> seen;
    for (const pugi::xml_attribute attribute : element.attributes()) {
      if (!seen.insert(attribute.name()).second)
        throw InputError(where, fmt::format("<{}> has the attribute {} twice", tag, attribute.name()));
      if (known && !known->allowed.contains(attribute.name()))
        throw InputError(where, fmt::format("<{}> has no attribute {}", tag, attribute.name()));
    }
    if (!known) return;  // an unknown element: whoever reads its parent complains
    for (const std::string_view required : known->required)
      if (!seen.contains(required))
        throw InputError(where, fmt::format("<{}> lacks the attribute {}", tag, required));
  }

  /// Replaces each $name by its value; the longest name that has one counts.
  std::string substitute(std::string_view text, const FileLocation& where) {
    std::string result;
    while (!text.empty()) {
      const size_t dollar = text.find('$');
      result += text.substr(0, dollar);
      if (dollar == text.npos) break;
      text.remove_prefix(dollar + 1);
      size_t length = 0;
      while (length < text.size() &&
             (std::isalnum(static_cast<unsigned char>(text[length])) || text[length] == '_'))
        ++length;
      const std::string_view whole = text.substr(0, length);
      while (length > 0 && !parameters_.contains(std::string(text.substr(0, length)))) --length;
      if (length == 0) throw InputError(where, fmt::format("the parameter ${} has no value", whole));
      const std::string name(text.substr(0, length));
      mentioned_.insert(name);
      const std::string& value = parameters_.at(name);
      substituted_ += value.size();
      if (substituted_ > kMaxSubstituted)
        throw InputError(where, fmt::format("${} and others stand for more than {} characters", name, kMaxSubstituted));
      result += value;
      text.remove_prefix(length);
    }
    return result;
  }

  XmlTree tree_;
  std::map<std::string, std::string> parameters_;
  std::set<std::string> mentioned_;
  std::filesystem::path scene_folder_;
  std::vector<std::filesystem::path> open_files_;  // the chain of includes
  size_t files_ = 0, substituted_ = 0;
  uint64_t bytes_ = 0;
};

}  // namespace

const std::string& XmlNode::attribute(std::string_view name) const {
  static const std::string none;
  for (const auto& [key, value] : attributes)
    if (key == name) return value;
  return none;
}

bool XmlNode::has(std::string_view name) const {
  return std::any_of(attributes.begin(), attributes.end(), [&](const auto& a) { return a.first == name; });
}

XmlTree read_xml(const std::filesystem::path& file, const std::map<std::string, std::string>& parameters) {
  return Reader(parameters).read(file);
}

}  // namespace tachylite
