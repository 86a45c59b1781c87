#include "scene/scene_loader.h"

#include <algorithm>

#include "base/error.h"
#include "base/fingerprint.h"
#include "base/log.h"
#include "base/parallel.h"
#include "scene/check_scene.h"
#include "scene/load_bsdf_adapter.h"
#include "scene/load_objects.h"
#include "scene/plugin.h"

namespace tachylite {
namespace {

/// All but how many samples are taken.
void add_node(Fingerprint& fingerprint, const XmlNode& node) {
  if (node.name() == "sample_count") return;
  fingerprint.add(node.tag);
  for (const auto& [name, value] : node.attributes) {
    fingerprint.add(name);
    fingerprint.add(value);
  }
  fingerprint.add(std::to_string(node.children.size()));
  for (const XmlNode& child : node.children) add_node(fingerprint, child);
}

}  // namespace

SceneLoader::SceneLoader(XmlTree tree, const LoadOptions& options)
    : tree_(std::move(tree)), permissive_(options.permissive) {
  scene.path = *tree_.root.where.file;
  folder_ = std::filesystem::path(scene.path).parent_path();
  Fingerprint fingerprint;
  add_node(fingerprint, tree_.root);
  scene.description = fingerprint.text();
  note_ids(tree_.root);
}

void SceneLoader::note_ids(const XmlNode& node) {
  for (const XmlNode& child : node.children) {
    if (child.tag != "ref" && child.has("id")) {
      if (tree_.aliases.contains(child.id()) || !ids_.emplace(child.id(), &child).second)
        throw InputError(child.where, fmt::format("id \"{}\" is given twice", child.id()));
    }
    note_ids(child);
  }
}

Scene SceneLoader::load() {
  load_used();
  load_unused();
  if (scene.sensors.empty()) throw InputError(tree_.root.where, "the scene has no sensor");
  if (scene.shapes.empty() && scene.emitters.empty())
    throw InputError(tree_.root.where, "the scene is empty: it has neither shapes nor emitters");
  check_scene(scene);
  return std::move(scene);
}

void SceneLoader::load_used() {
  scene.integrator.where = tree_.root.where;
  const XmlNode* integrator = nullptr;
  for (const XmlNode& child : tree_.root.children) {
    if (child.tag == "shape" && child.type() != "shapegroup") load_shape(*this, child, dmat4(1));
    if (child.tag == "emitter") load_emitter(*this, child);
    if (child.tag == "sensor") load_sensor(*this, child);
    if (child.tag != "integrator") continue;
    if (integrator) throw InputError(child.where, "the scene has several integrators, expected one");
    integrator = &child;
    load_integrator(*this, child);
  }
  if (std::any_of(two_sided_.begin(), two_sided_.end(), [](const auto& made) { return made.first != made.second; }))
    log_warning(fmt::format("{}: opaque materials of this file of version 0.x are taken as two-sided (without "
                            "--permissive their backs are black, as in Mitsuba)",
                            tree_.root.where.str()));
  run_jobs();
  check_mesh_attributes();
  loaded_.clear();
  textures_of_.clear();
}

/// Objects that nothing refers to must be right, too, but the scene does not hold them.
void SceneLoader::load_unused() {
  Scene used = std::move(scene);
  scene = {};
  for (const XmlNode& child : tree_.root.children) {
    if (child.used) continue;
    if (child.tag == "bsdf") bsdf(child);
    if (child.tag == "texture") texture(child);
    if (child.tag == "medium") medium(child);
    if (child.tag == "shape") load_shape_group(*this, child, dmat4(1));  // others are used
    const bool definition = child.tag == "film" || child.tag == "sampler" || child.tag == "rfilter" ||
                            child.tag == "phase" || child.tag == "volume" || child.tag == "spectrum";
    if (!child.used && !(definition && child.has("id")))
      refuse(child.where, fmt::format("<{}> means nothing inside <scene>", child.tag));
  }
  run_jobs();
  scene = std::move(used);
}

/// A shape must have the attributes that its bsdf and its emitter ask for.
void SceneLoader::check_mesh_attributes() const {
  const std::function<void(const Shape&, TextureIndex)> check = [&](const Shape& shape, TextureIndex texture) {
    const auto& kind = scene.textures[static_cast<size_t>(texture)].kind;
    if (const auto* board = std::get_if<CheckerboardTexture>(&kind))
      for (const ColorInput* color : {&board->color0, &board->color1})
        if (color->texture != kNone) check(shape, color->texture);
    const auto* wanted = std::get_if<MeshAttributeTexture>(&kind);
    if (!wanted) return;
    if (const auto* mesh = std::get_if<MeshShape>(&shape.kind))
      for (const MeshAttribute& attribute : mesh->mesh->attributes)
        if (attribute.name == wanted->name) return;
    throw InputError(shape.where,
                     fmt::format("{} has no attribute {}, which its material asks for ({})", shape.plugin,
                                 wanted->name, scene.textures[static_cast<size_t>(texture)].where.str()));
  };
  for (const Shape& shape : scene.shapes) {
    if (const auto textures = textures_of_.find(shape.bsdf); textures != textures_of_.end())
      for (const TextureIndex texture : textures->second) check(shape, texture);
    if (shape.emitter == kNone) continue;
    const auto* area = std::get_if<AreaEmitter>(&scene.emitters[static_cast<size_t>(shape.emitter)].kind);
    if (area && area->radiance.texture != kNone) check(shape, area->radiance.texture);
  }
}

void SceneLoader::refuse(const FileLocation& where, const std::string& message) const {
  if (!permissive_) throw InputError(where, message);
  log_warning(fmt::format("{}: {}; ignored", where.str(), message));
}

std::filesystem::path SceneLoader::find_file(const XmlNode& node, const std::string& name) {
  std::vector<std::filesystem::path> folders = tree_.search_folders;
  folders.push_back(folder_);
  folders.push_back(std::filesystem::path(*node.where.file).parent_path());
  if (std::filesystem::path(name).is_absolute()) folders = {""};
  std::error_code failed;
  for (const auto& folder : folders)
    if (std::filesystem::is_regular_file(folder / name, failed)) {
      const std::string path = (folder / name).string();
      if (files_named_.insert(path).second) scene.files.push_back(path);
      return folder / name;
    }
  throw InputError(node.where, fmt::format("the file \"{}\" does not exist", name));
}

const XmlNode& SceneLoader::resolve(const XmlNode& node) const {
  if (node.tag != "ref") return node;
  std::string id = node.id();
  constexpr size_t kMostHops = 64;
  for (size_t hops = 0; tree_.aliases.contains(id); ++hops) {
    if (hops > kMostHops)
      throw InputError(node.where, fmt::format("alias \"{}\" refers to itself, or stands at the end of more than {}", id,
                                               kMostHops));
    id = tree_.aliases.at(id);
  }
  const auto found = ids_.find(id);
  if (found == ids_.end()) throw InputError(node.where, fmt::format("nothing has the id \"{}\"", id));
  return *found->second;
}

SceneLoader::Nesting::Nesting(SceneLoader& loader, const XmlNode& node) : loader_(loader), node_(node) {
  constexpr size_t kDeepest = 64;
  if (loader.loading_.contains(&node))
    throw InputError(node.where, fmt::format("<{}> \"{}\" contains itself by reference", node.tag, node.id()));
  if (loader.loading_.size() >= kDeepest)
    throw InputError(node.where, fmt::format("references are nested more than {} deep", kDeepest));
  loader.loading_.insert(&node);
}

int SceneLoader::once(const XmlNode& node, const std::function<int()>& load) {
  if (const auto found = loaded_.find(&node); found != loaded_.end()) return found->second;
  const Nesting nesting(*this, node);
  const int index = load();
  loaded_.emplace(&node, index);
  return index;
}

TextureIndex SceneLoader::texture(const XmlNode& node) {
  const XmlNode& target = resolve(node);
  const TextureIndex read = once(target, [&] {
    const auto index = static_cast<TextureIndex>(scene.textures.size());
    scene.textures.emplace_back();
    Texture texture = load_texture(*this, target, index);
    scene.textures[static_cast<size_t>(index)] = std::move(texture);
    return index;
  });
  textures_seen_.insert(read);
  return read;
}

TextureIndex SceneLoader::constant_texture(const FileLocation& where, const dvec3& color) {
  scene.textures.push_back({where, dmat3(1), CheckerboardTexture{color, color}});
  return static_cast<TextureIndex>(scene.textures.size()) - 1;
}

BsdfIndex SceneLoader::bsdf(const XmlNode& node) {
  const XmlNode& target = resolve(node);
  std::set<TextureIndex> outside;
  outside.swap(textures_seen_);
  const BsdfIndex read = once(target, [&] {
    BsdfKind kind = load_bsdf(*this, target);  // may append children
    scene.bsdfs.push_back({target.where, target.id(), target.type(), std::move(kind)});
    const auto index = static_cast<BsdfIndex>(scene.bsdfs.size()) - 1;
    textures_of_[index] = textures_seen_;
    return index;
  });
  textures_seen_ = std::move(outside);
  textures_seen_.insert(textures_of_[read].begin(), textures_of_[read].end());
  return read;
}

BsdfIndex SceneLoader::default_bsdf(const std::string& name, const BsdfKind& kind) {
  const auto [entry, added] = defaults_.emplace(name, static_cast<BsdfIndex>(scene.bsdfs.size()));
  if (added) scene.bsdfs.push_back({tree_.root.where, "", name, kind});
  return entry->second;
}

BsdfIndex SceneLoader::two_sided_bsdf(BsdfIndex index) {
  if (const auto found = two_sided_.find(index); found != two_sided_.end()) return found->second;
  Bsdf bsdf = scene.bsdfs[static_cast<size_t>(index)];
  bool changed = false;
  const auto enter = [&](BsdfIndex& child) {
    const BsdfIndex before = child;
    child = two_sided_bsdf(child);
    changed = changed || child != before;
  };
  if (auto* mask = std::get_if<MaskBsdf>(&bsdf.kind)) {
    enter(mask->child);
  } else if (auto* blend = std::get_if<BlendBsdf>(&bsdf.kind)) {
    enter(blend->first);
    enter(blend->second);
  } else if (auto* map = std::get_if<NormalMapBsdf>(&bsdf.kind)) {
    enter(map->child);
  } else if (auto* bump = std::get_if<BumpMapBsdf>(&bsdf.kind)) {
    enter(bump->child);
  } else if (!std::holds_alternative<TwoSidedBsdf>(bsdf.kind) && !transmits(scene, index)) {
    bsdf.kind = TwoSidedBsdf{index, index};
    changed = true;
  }
  BsdfIndex result = index;
  if (changed) {
    result = static_cast<BsdfIndex>(scene.bsdfs.size());
    textures_of_[result] = textures_of_[index];
    scene.bsdfs.push_back(std::move(bsdf));
  }
  two_sided_.emplace(index, result);
  return result;
}

MediumIndex SceneLoader::medium(const XmlNode& node) {
  const XmlNode& target = resolve(node);
  return once(target, [&] {
    scene.media.push_back(load_medium(*this, target));
    return static_cast<MediumIndex>(scene.media.size()) - 1;
  });
}

void SceneLoader::defer(std::function<void()> load, std::function<void()> finish) {
  jobs_.push_back({std::move(load), std::move(finish)});
}

void SceneLoader::run_jobs() {
  // The complaint is that of the first file in the scene, whichever thread was faster.
  parallel_for_each(jobs_.size(), [&](size_t i) {
    if (jobs_[i].load) jobs_[i].load();
  });
  for (const Job& job : jobs_)
    if (job.finish) job.finish();
  jobs_.clear();
}

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
  return SceneLoader(read_xml(file, options.parameters), options).load();
}

}  // namespace tachylite
