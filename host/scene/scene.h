#pragma once

// The scene as the user described it: plain structs in double precision, in the words of Mitsuba 3's scene format.
// Nothing here is optimised, merged or converted for a device; that is pack/'s work. Every object keeps the file
// and line it came from, so that a later complaint still names them.
//
// Lengths are in scene units. Colours are linear Rec.709 triples. Transforms are object-to-world unless named
// otherwise. Indices refer to the vectors of Scene; -1 means none.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "base/file_location.h"

namespace tachylite {

using glm::dmat3;
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;

using TextureIndex = int;
using BsdfIndex = int;
using MeshIndex = int;
using EmitterIndex = int;
using MediumIndex = int;
constexpr int kNone = -1;

// ---------------------------------------------------------------------------------------------- textures

/// How texels were stored in the file; decides the format on the device (8-bit stays 8-bit).
enum class TexelFormat { kUnorm8Srgb, kUnorm8Linear, kHalf, kFloat };
enum class WrapMode { kRepeat, kMirror, kClamp };
enum class FilterType { kNearest, kBilinear };

/// A parameter that is a constant or a texture. As a scalar (alpha, weight, opacity, height) a texture of three
/// channels counts as its luminance (.212671, .715160, .072169).
struct ColorInput {
  dvec3 value{0};
  TextureIndex texture = kNone;
  ColorInput() = default;
  ColorInput(double grey) : value(grey) {}
  ColorInput(dvec3 color) : value(color) {}
};
struct ScalarInput {
  double value = 0;
  TextureIndex texture = kNone;
  ScalarInput() = default;
  ScalarInput(double v) : value(v) {}
};

/// A decoded image file, shared by all textures that name the same file.
/// 8-bit formats: `bytes`, width*height*channels, row 0 on top; float formats: `floats`, the same order.
struct Bitmap {
  std::string path;
  int width = 0, height = 0;
  int channels = 0;  // 1 (grey), 3 or 4; alpha is kept but not used as colour
  bool half = false; // the file held 16-bit floats; `floats` has them widened
  std::vector<uint8_t> bytes;
  std::vector<float> floats;
};

/// plugin `bitmap`. v = 0 is the first (top) row; texel centres at (i + 0.5) / resolution.
struct BitmapTexture {
  std::shared_ptr<const Bitmap> bitmap;
  TexelFormat format = TexelFormat::kUnorm8Srgb;  // kUnorm8Linear when raw
  bool raw = false;
  WrapMode wrap = WrapMode::kRepeat;
  FilterType filter = FilterType::kBilinear;
};
/// plugin `checkerboard`: color0 where (frac(u) > 0.5) == (frac(v) > 0.5), color1 elsewhere; as a scalar the other way
/// round. A texture there is looked up by its own to_uv, at the uv that the checkerboard was asked at.
struct CheckerboardTexture {
  ColorInput color0{0.4}, color1{0.2};
};
constexpr int kMostCheckerboards = 4;  // inside one another
/// plugin `mesh_attribute`: interpolates the attribute of that name (vertex_NAME, face_NAME) of the mesh hit.
struct MeshAttributeTexture {
  std::string name;
  double scale = 1;
};
struct Texture {
  FileLocation where;
  dmat3 to_uv{1};  // acts on (u, v, 1)
  std::variant<BitmapTexture, CheckerboardTexture, MeshAttributeTexture> kind;
};

// ------------------------------------------------------------------------------------------------- bsdfs

enum class MicrofacetDistribution { kBeckmann, kGgx };
struct Roughness {
  MicrofacetDistribution distribution = MicrofacetDistribution::kBeckmann;
  ScalarInput alpha_u{0.1}, alpha_v{0.1};
  bool sample_visible = true;  // only affects noise; always true here
};

struct DiffuseBsdf { ColorInput reflectance{0.5}; };
/// Oren-Nayar; plugin `roughdiffuse` of Mitsuba 0.6 (alpha = its roughness; converted as 0.6 does).
struct RoughDiffuseBsdf { ColorInput reflectance{0.5}; ScalarInput alpha{0.2}; bool use_fast_approx = false; };
struct ConductorBsdf { ColorInput eta{0.0}, k{1.0}, specular_reflectance{1.0}; };
struct RoughConductorBsdf { Roughness roughness; ColorInput eta{0.0}, k{1.0}, specular_reflectance{1.0}; };
/// eta = int_ior / ext_ior everywhere below.
struct DielectricBsdf { double eta = 1.5046 / 1.000277; ColorInput specular_reflectance{1.0}, specular_transmittance{1.0}; };
struct ThinDielectricBsdf { double eta = 1.5046 / 1.000277; ColorInput specular_reflectance{1.0}, specular_transmittance{1.0}; };
struct RoughDielectricBsdf {
  double eta = 1.5046 / 1.000277;
  Roughness roughness;
  ColorInput specular_reflectance{1.0}, specular_transmittance{1.0};
};
struct PlasticBsdf {
  double eta = 1.49 / 1.000277;
  ColorInput diffuse_reflectance{0.5}, specular_reflectance{1.0};
  bool nonlinear = false;
};
struct RoughPlasticBsdf {
  double eta = 1.49 / 1.000277;
  Roughness roughness;  // isotropic: alpha_u == alpha_v, constant
  ColorInput diffuse_reflectance{0.5}, specular_reflectance{1.0};
  bool nonlinear = false;
  /// Mitsuba 0.6: what the coat does not let out comes back to the base. Mitsuba 3: only what one reflection at the
  /// rough coat returns, which is less, as single scattering loses light.
  bool keeps_light_inside = false;
};
struct PrincipledBsdf {
  ColorInput base_color{0.5};
  ScalarInput roughness{0.5}, anisotropic{0.0}, metallic{0.0}, spec_trans{0.0}, spec_tint{0.0}, sheen{0.0},
      sheen_tint{0.0}, flatness{0.0}, clearcoat{0.0}, clearcoat_gloss{0.0};
  double eta = 0;  // from `eta` or `specular` (scene-format.md); relative to the outside
  double diffuse_reflectance_sampling_rate = 1, main_specular_sampling_rate = 1, clearcoat_sampling_rate = 1;
};
struct PrincipledThinBsdf {
  ColorInput base_color{0.5};
  ScalarInput roughness{0.5}, anisotropic{0.0}, spec_trans{0.0}, spec_tint{0.0}, sheen{0.0}, sheen_tint{0.0},
      flatness{0.0}, eta{1.5}, diff_trans{0.0};
  double diffuse_reflectance_sampling_rate = 1, specular_reflectance_sampling_rate = 1,
         specular_transmittance_sampling_rate = 1, diffuse_transmittance_sampling_rate = 1;
};
/// Our own: f = kd/pi + ks (n+2)/(2 pi) (n_s.h)^n with kd + ks <= 1. specular_weight, when given, picks diffuse (0)
/// or specular (1) per point instead of the sum.
struct BlinnPhongBsdf {
  ColorInput diffuse_reflectance{0.5}, specular_reflectance{0.2};
  ScalarInput exponent{30.0};
  std::optional<ScalarInput> specular_weight;
};
/// Our own, Nori's `microfacet`: f = kd/pi + (1 - max kd) D F G / (4 cos_i cos_o), Beckmann.
struct MicrofacetBsdf { ColorInput kd{0.5}; ScalarInput alpha{0.1}; double int_ior = 1.5046, ext_ior = 1.000277; };
/// Our own: lets `transparency` of the light straight through; the rest is two-sided diffuse.
struct PaperBsdf { ColorInput reflectance{0.5}; ScalarInput transparency{0.0}; };
struct NullBsdf {};

/// Adapters around other bsdfs (children are indices into Scene::bsdfs).
struct TwoSidedBsdf { BsdfIndex front = kNone, back = kNone; };  // back == front: one child serves both sides
struct MaskBsdf { BsdfIndex child = kNone; ScalarInput opacity{0.5}; };
struct BlendBsdf { BsdfIndex first = kNone, second = kNone; ScalarInput weight{0.5}; };  // (1-w) first + w second
struct NormalMapBsdf {
  BsdfIndex child = kNone;
  TextureIndex normalmap = kNone;
  bool flip_invalid_normals = true, use_shadowing_function = true;
};
struct BumpMapBsdf {
  BsdfIndex child = kNone;
  TextureIndex height = kNone;  // displacement in scene units after `scale`
  double scale = 1;
  bool flip_invalid_normals = true, use_shadowing_function = true;
};

using BsdfKind =
    std::variant<DiffuseBsdf, RoughDiffuseBsdf, ConductorBsdf, RoughConductorBsdf, DielectricBsdf, ThinDielectricBsdf,
                 RoughDielectricBsdf, PlasticBsdf, RoughPlasticBsdf, PrincipledBsdf, PrincipledThinBsdf, BlinnPhongBsdf,
                 MicrofacetBsdf, PaperBsdf, NullBsdf, TwoSidedBsdf, MaskBsdf, BlendBsdf, NormalMapBsdf, BumpMapBsdf>;
struct Bsdf {
  FileLocation where;
  std::string id;      // may be empty
  std::string plugin;  // as written, for messages and `info`
  BsdfKind kind;
};

// ------------------------------------------------------------------------------------------------- media

struct IsotropicPhase {};
struct HenyeyGreensteinPhase { double g = 0.8; };  // g > 0 scatters forward
struct PhaseFunction;
struct BlendPhase {
  std::shared_ptr<const PhaseFunction> first, second;
  double weight = 0.5;  // of the second
};
struct PhaseFunction {
  FileLocation where;
  std::variant<IsotropicPhase, HenyeyGreensteinPhase, BlendPhase> kind;
};

/// A .vol file: nx*ny*nz*channels floats, x fastest, over the unit cube of its own space.
struct Grid {
  std::string path;
  int nx = 0, ny = 0, nz = 0, channels = 0;
  std::vector<float> values;
  dvec3 bbox_min{0}, bbox_max{1};  // as written in the file; used with use_grid_bbox
};
/// plugin gridvolume or constvolume: over the unit cube mapped by to_world. A medium ends at the box, parallel to the
/// axes, around the cube of its sigma_t; albedo goes on beyond its own.
struct Volume {
  FileLocation where;
  std::shared_ptr<const Grid> grid;  // null: the constant
  dvec3 constant{1};
  dmat4 to_world{1};
  FilterType filter = FilterType::kBilinear;  // trilinear
  WrapMode wrap = WrapMode::kClamp;
  bool use_grid_bbox = false;
};
struct HomogeneousMedium { dvec3 sigma_t{1}, albedo{0.75}; };  // [1/length], scale already applied to sigma_t
struct HeterogeneousMedium { Volume sigma_t, albedo; double scale = 1; };
struct Medium {
  FileLocation where;
  std::string id;
  std::variant<HomogeneousMedium, HeterogeneousMedium> kind;
  PhaseFunction phase;
};

// ---------------------------------------------------------------------------------------------- emitters

/// plugin `area`: one-sided, on the side of the normal. radiance [W/sr/m^2].
struct AreaEmitter { ColorInput radiance{1.0}; };
struct ConstantEmitter { dvec3 radiance{1}; };
/// plugin `envmap`: lookup by (u, v) = (atan2(d.x, -d.z)/2pi, acos(d.y)/pi) of d = inverse(to_world) * direction.
struct EnvironmentEmitter { std::shared_ptr<const Bitmap> bitmap; bool srgb = false; double scale = 1; dmat4 to_world{1}; };
struct PointEmitter { dvec3 position{0}; dvec3 intensity{1}; };                  // [W/sr]
struct DirectionalEmitter { dvec3 direction{0, 0, 1}; dvec3 irradiance{1}; };    // direction of propagation
struct DirectionalAreaEmitter { ColorInput radiance{1.0}; };                     // on a shape
/// plugin `spot`: along local +z; angles in radians.
struct SpotEmitter {
  dmat4 to_world{1};
  dvec3 intensity{1};
  double cutoff_angle = 0.3490658503988659, beam_width = 0.2617993877991494;
  TextureIndex texture = kNone;
};
struct ProjectorEmitter { dmat4 to_world{1}; TextureIndex irradiance = kNone; dvec3 irradiance_value{1}; double scale = 1; double x_fov = 0; };

struct Emitter {
  FileLocation where;
  std::string plugin;
  std::variant<AreaEmitter, DirectionalAreaEmitter, ConstantEmitter, EnvironmentEmitter, PointEmitter, DirectionalEmitter,
               SpotEmitter, ProjectorEmitter>
      kind;
  int shape = kNone;  // AreaEmitter and DirectionalAreaEmitter: index into Scene::shapes
};

// ------------------------------------------------------------------------------------------------ shapes

/// Triangle mesh in object space. normals and uvs are empty or one per vertex.
struct MeshAttribute { std::string name; int channels = 0; std::vector<float> values; };  // vertex_* or face_*
struct Mesh {
  std::string path;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  // empty: flat (face normals)
  std::vector<glm::vec2> uvs;      // empty: barycentrics serve as uv
  std::vector<glm::uvec3> triangles;
  std::vector<MeshAttribute> attributes;
};
struct MeshShape { std::shared_ptr<const Mesh> mesh; };
struct RectangleShape {};                                             // [-1,1]^2 in xy, normal +z
struct CubeShape {};                                                  // [-1,1]^3, per-face uv
struct SphereShape { dvec3 center{0}; double radius = 1; };           // before to_world
struct DiskShape {};                                                  // radius 1, normal +z
struct CylinderShape { dvec3 p0{0, 0, 0}, p1{0, 0, 1}; double radius = 1; };  // no caps, normal outwards
struct Shape {
  FileLocation where;
  std::string id, plugin;
  std::variant<MeshShape, RectangleShape, CubeShape, SphereShape, DiskShape, CylinderShape> kind;
  dmat4 to_world{1};
  bool flip_normals = false;
  bool face_normals = false;  // meshes: ignore vertex normals
  BsdfIndex bsdf = kNone;     // always set after loading (default: diffuse .5, or black under an area emitter)
  EmitterIndex emitter = kNone;
  /// interior: the side opposite to the geometric normal. Meaningful when is_medium_boundary.
  MediumIndex interior = kNone, exterior = kNone;
  bool is_medium_boundary = false;  // an interior or exterior medium was named
};

// ----------------------------------------------------------------------------------------- sensor, film

enum class ReconstructionFilter { kBox, kTent, kGaussian };
struct Film {
  int width = 768, height = 576;                                   // the full film
  int crop_x = 0, crop_y = 0, crop_width = 768, crop_height = 576;  // the image that is rendered
  ReconstructionFilter filter = ReconstructionFilter::kGaussian;
  double filter_radius = 2;      // pixels: box .5, tent 1 by default, gaussian 4*stddev
  double gaussian_stddev = 0.5;  // pixels
};
/// Camera space: +x left, +y up, +z forward (Mitsuba's convention).
struct Sensor {
  enum class Kind { kPerspective, kThinLens, kOrthographic };
  FileLocation where;
  std::string id;
  Kind kind = Kind::kPerspective;
  dmat4 to_world{1};
  double x_fov = 0;  // radians, full horizontal angle of the full film; perspective and thinlens
  double near_clip = 1e-2, far_clip = 1e4;
  dvec2 principal_point_offset{0};  // fractions of the full film
  double aperture_radius = 0, focus_distance = 0;
  MediumIndex medium = kNone;
  Film film;
  int sample_count = 4;
  uint32_t seed = 0;
  std::string sampler = "independent";  // as written in the scene; the default sampler is ours
};

struct Integrator {
  enum class Kind { kDirect, kPath, kVolpath, kVolpathMis };
  FileLocation where;
  Kind kind = Kind::kPath;
  int max_depth = -1;  // -1: unlimited. 1: only emitters seen directly, 2: direct light...
  int rr_depth = 5;    // Russian roulette from this depth on
  bool hide_emitters = false;
  /// Which strategies find the light, for teaching and tests: both (MIS), emitter sampling only, BSDF sampling only.
  enum class Strategy { kMis, kEmitterOnly, kBsdfOnly };
  Strategy strategy = Strategy::kMis;
  bool moment = false;                 // `moment` around it: adds second moments
  std::vector<std::string> aovs;       // `aov` around it, e.g. "albedo", "sh_normal", "depth"
};

struct Scene {
  std::string path;               // of the file that was loaded
  std::string description;        // fingerprint of the XML, with values of $names
  std::vector<std::string> files;  // that it refers to, in its order
  Integrator integrator;
  std::vector<Sensor> sensors;
  std::vector<Texture> textures;
  std::vector<Bsdf> bsdfs;
  std::vector<Medium> media;
  std::vector<Emitter> emitters;
  std::vector<Shape> shapes;
};

}  // namespace tachylite
