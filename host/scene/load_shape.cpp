#include <algorithm>
#include <bit>
#include <cmath>

#include "base/error.h"
#include "base/memory.h"
#include "scene/load_mesh.h"
#include "scene/load_objects.h"
#include "scene/parse_transform.h"
#include "scene/plugin.h"

namespace tachylite {
namespace {

SphereShape load_sphere(const Plugin& plugin, const Shape& shape) {
  SphereShape sphere;
  sphere.center = plugin.vector("center", sphere.center);
  sphere.radius = plugin.real("radius", sphere.radius, kPositive);
  if (!is_similarity(shape.to_world))
    throw InputError(plugin.where("to_world"), "to_world of sphere must scale all axes alike, and not shear");
  return sphere;
}

CylinderShape load_cylinder(const Plugin& plugin, const Shape& shape) {
  CylinderShape cylinder;
  cylinder.p0 = plugin.vector("p0", cylinder.p0);
  cylinder.p1 = plugin.vector("p1", cylinder.p1);
  cylinder.radius = plugin.real("radius", cylinder.radius, kPositive);
  const dvec3 axis = cylinder.p1 - cylinder.p0;
  if (glm::length(axis) == 0) plugin.fail("p1", "a point different from p0");
  // The cross section must stay a circle, and perpendicular to the axis.
  const dvec3 z = glm::normalize(axis);
  const dvec3 x = glm::normalize(glm::cross(z, std::abs(z.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  const dmat3 linear(shape.to_world);
  const dvec3 a = linear * x, b = linear * glm::cross(z, x), c = linear * z;
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  constexpr double kTolerance = 1e-4;
  if (std::abs(la - lb) > kTolerance * la || std::abs(glm::dot(a, b)) > kTolerance * la * lb ||
      std::abs(glm::dot(a, c)) > kTolerance * la * lc || std::abs(glm::dot(b, c)) > kTolerance * lb * lc)
    throw InputError(plugin.where("to_world"), "to_world of cylinder must keep its cross section a circle");
  return cylinder;
}

/// Reads the file later, together with others; the mesh is filled in then. Normals are computed where the
/// shape's own to_world puts it: inside a group, that is in the group's space.
void load_mesh_shape(SceneLoader& loader, const Plugin& plugin, Shape& shape, size_t index,
                     const dmat4& to_world) {
  MeshRequest request;
  request.format = plugin.type() == "obj" ? MeshRequest::Format::kObj : MeshRequest::Format::kPly;
  request.file = plugin.file("filename");
  request.flip_tex_coords = plugin.boolean("flip_tex_coords", request.format == MeshRequest::Format::kObj);
  request.face_normals = shape.face_normals = plugin.boolean("face_normals", false);
  const dmat3 linear(to_world);
  if (!request.face_normals && (!is_similarity(to_world, 1e-6) || glm::determinant(linear) < 0))
    request.to_world = linear;

  std::string key = fmt::format("mesh {} {} {}", request.flip_tex_coords, request.face_normals,
                                std::filesystem::weakly_canonical(request.file).string());
  if (request.to_world)
    for (int i = 0; i < 9; ++i) key += fmt::format(" {}", linear[i / 3][i % 3]);
  const auto slot = loader.deferred_file<Mesh>(key, [request] { return load_mesh(request); });
  loader.defer({}, [&loader, slot, index] { loader.scene.shapes[index].kind = MeshShape{*slot}; });
}

/// <medium name="interior"> or <ref name="interior">
MediumIndex load_side(SceneLoader& loader, const Plugin& plugin, const char* side) {
  const XmlNode* child = plugin.take(side);
  if (!child) return kNone;
  const XmlNode& target = loader.resolve(*child);
  if (target.tag != "medium")
    throw InputError(child->where,
                     fmt::format("{} of {} is a <{}>, expected <medium>", side, plugin.type(), target.tag));
  return loader.medium(target);
}

BsdfIndex load_strict_bsdf(SceneLoader& loader, const Plugin& plugin, const Shape& shape, bool emits) {
  if (const XmlNode* bsdf = plugin.object("bsdf")) return loader.bsdf(*bsdf);
  // 0.6 takes the border of a medium for one without a surface.
  if (plugin.node().legacy && shape.is_medium_boundary && !emits)
    return loader.default_bsdf("null", NullBsdf{});
  if (emits) return loader.default_bsdf("diffuse (black)", DiffuseBsdf{0.0});
  return loader.default_bsdf("diffuse", DiffuseBsdf{0.5});
}

/// Mitsuba 0.6 shades the backs of opaque materials black. Many of its files come from renderers that do not, and show
/// walls from behind: a reader that is asked not to be strict takes them as two-sided.
BsdfIndex load_shape_bsdf(SceneLoader& loader, const Plugin& plugin, const Shape& shape, bool emits) {
  const BsdfIndex bsdf = load_strict_bsdf(loader, plugin, shape, emits);
  return plugin.node().legacy && loader.permissive() ? loader.two_sided_bsdf(bsdf) : bsdf;
}

/// Copies of a group's shapes. They share meshes, bsdfs and media, but each is a shape of the scene.
void load_instance(SceneLoader& loader, const Plugin& plugin) {
  const XmlNode* group = plugin.object("shape");
  if (!group || group->type() != "shapegroup")
    throw InputError(plugin.where(), "instance names no shapegroup");
  const dmat4 to_world = plugin.transform("to_world");
  plugin.finish();
  load_shape_group(loader, *group, to_world);
}

}  // namespace

void load_shape_group(SceneLoader& loader, const XmlNode& node, const dmat4& placement) {
  const Plugin plugin(loader, node);
  for (const XmlNode* shape : plugin.objects("shape")) {
    if (shape->type() == "instance" || shape->type() == "shapegroup")
      throw InputError(shape->where, fmt::format("{} cannot stand inside a shapegroup", shape->type()));
    const size_t emitters = loader.scene.emitters.size();
    load_shape(loader, *shape, placement);
    if (loader.scene.emitters.size() > emitters)
      throw InputError(loader.scene.emitters.back().where, "an emitter cannot stand inside a shapegroup");
  }
  plugin.finish();
}

void load_shape(SceneLoader& loader, const XmlNode& node, const dmat4& placement) {
  const Plugin plugin(loader, node);
  const std::string& type = plugin.type();
  if (type == "instance") return load_instance(loader, plugin);
  const size_t index = loader.scene.shapes.size();
  if (std::has_single_bit(index))  // about to grow: instances let few lines mean very many
    require_memory(node.where, fmt::format("a scene of more than {} shapes", index), 3 * index * sizeof(Shape));
  Shape shape;
  shape.where = node.where;
  shape.id = node.id();
  shape.plugin = type;
  const dmat4 own_to_world = plugin.transform("to_world");
  shape.to_world = placement * own_to_world;
  shape.flip_normals = plugin.boolean("flip_normals", false);

  // Its form.
  if (type == "rectangle") {
    shape.kind = RectangleShape{};
  } else if (type == "cube") {
    shape.kind = CubeShape{};
  } else if (type == "disk") {
    shape.kind = DiskShape{};
  } else if (type == "sphere") {
    shape.kind = load_sphere(plugin, shape);
  } else if (type == "cylinder") {
    shape.kind = load_cylinder(plugin, shape);
  } else if (type == "obj" || type == "ply") {
    load_mesh_shape(loader, plugin, shape, index, own_to_world);
  } else {
    return loader.refuse(node.where, fmt::format("the shape plugin {} is not supported", type));
  }

  // What it is made of, what lies on its sides, what it emits.
  shape.interior = load_side(loader, plugin, "interior");
  shape.exterior = load_side(loader, plugin, "exterior");
  shape.is_medium_boundary = shape.interior != kNone || shape.exterior != kNone;
  const XmlNode* emitter = plugin.object("emitter");
  shape.bsdf = load_shape_bsdf(loader, plugin, shape, emitter != nullptr);
  if (emitter) {
    const size_t before = loader.scene.emitters.size();
    load_emitter(loader, *emitter, static_cast<int>(index));
    if (loader.scene.emitters.size() > before) shape.emitter = static_cast<EmitterIndex>(before);
  }
  plugin.ignore({"silhouette_sampling_weight"});
  plugin.finish();
  loader.scene.shapes.push_back(std::move(shape));
}

}  // namespace tachylite
