// Closest and any hit among primitives that are specialization constants (shared/baked.h): no tree, no loads, no
// branches; boxes as three pairs of planes. A kernel defines BAKED_COUNT, a multiple of 8 up to 64, before including this file.
#ifndef TACHYLITE_GEOMETRY_BAKED_GLSL
#define TACHYLITE_GEOMETRY_BAKED_GLSL
#include "shared/baked.h"

// Primitive 8 a + b is named by its octal digits a and b, so that the preprocessor can count.
#define BAKED_CONSTANT(a, b, c, type, name) \
  layout(constant_id = kBakedFirstConstant + kBakedConstants * (8 * a + b) + c) const type name##_##a##b = type(0);
#define BAKED_DECLARE(a, b) \
  BAKED_CONSTANT(a, b, 0, uint, baked_kind) \
  BAKED_CONSTANT(a, b, 1, float, baked_nx) \
  BAKED_CONSTANT(a, b, 2, float, baked_ny) \
  BAKED_CONSTANT(a, b, 3, float, baked_nz) \
  BAKED_CONSTANT(a, b, 4, float, baked_nw) \
  BAKED_CONSTANT(a, b, 5, float, baked_ax) \
  BAKED_CONSTANT(a, b, 6, float, baked_ay) \
  BAKED_CONSTANT(a, b, 7, float, baked_az) \
  BAKED_CONSTANT(a, b, 8, float, baked_aw) \
  BAKED_CONSTANT(a, b, 9, float, baked_bx) \
  BAKED_CONSTANT(a, b, 10, float, baked_by) \
  BAKED_CONSTANT(a, b, 11, float, baked_bz) \
  BAKED_CONSTANT(a, b, 12, float, baked_bw) \
  BAKED_CONSTANT(a, b, 13, float, baked_h) \
  BAKED_CONSTANT(a, b, 14, float, baked_k) \
  BAKED_CONSTANT(a, b, 15, uint, baked_hit)

#define BAKED_EIGHT(macro, a) \
  macro(a, 0) macro(a, 1) macro(a, 2) macro(a, 3) macro(a, 4) macro(a, 5) macro(a, 6) macro(a, 7)
#define BAKED_SIXTEEN(macro, a, b) BAKED_EIGHT(macro, a) BAKED_EIGHT(macro, b)
#if BAKED_COUNT <= 8
#define BAKED_ALL(macro) BAKED_EIGHT(macro, 0)
#elif BAKED_COUNT <= 16
#define BAKED_ALL(macro) BAKED_SIXTEEN(macro, 0, 1)
#elif BAKED_COUNT <= 24
#define BAKED_ALL(macro) BAKED_SIXTEEN(macro, 0, 1) BAKED_EIGHT(macro, 2)
#elif BAKED_COUNT <= 32
#define BAKED_ALL(macro) BAKED_SIXTEEN(macro, 0, 1) BAKED_SIXTEEN(macro, 2, 3)
#else
#define BAKED_ALL(macro) \
  BAKED_SIXTEEN(macro, 0, 1) BAKED_SIXTEEN(macro, 2, 3) BAKED_SIXTEEN(macro, 4, 5) BAKED_SIXTEEN(macro, 6, 7)
#endif

BAKED_ALL(BAKED_DECLARE)

// Bound of the error of a point on a plane, relative to its terms, and of the side of the plane on which hit_baked sees
// the origin of a ray that offset_origin moved off it: no ray meets the plane that it leaves.
const float kGammaPlane = 12.0 * 5.9604645e-8;

struct BakedRay {
  vec3 o, d;
  uint ignored, ignored_target;  // hits that the ray leaves and that it aims at (kNoHit: none)
};

// Whether two hits are on the same primitive.
bool same_baked(uint kind, uint id, uint hit) {
  return kind == kBakedTriangle ? id == hit : (id | 1u) == (hit | 1u) && hit != 0xffffffffu;
}

// Of a NaN in `b` it gives NaN; max() has another rule, and costs two more instructions for it.
float larger(float a, float b) { return a > b ? a : b; }
float smaller(float a, float b) { return a < b ? a : b; }

// Smallest t in (0, tmax) at which the ray meets the primitive; tmax if it does not.
float hit_baked(BakedRay ray, float tmax, uint id, uint kind_and_flag, vec3 N, float wN, vec3 A, float wA, vec3 B,
                float wB, float h, float k) {
  uint kind = kind_and_flag & kBakedKindMask;
  bool is_target = (kind_and_flag & kBakedEmits) != 0u && same_baked(kind, id, ray.ignored_target);
  if (kind == kBakedSphere) {
    // Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection"; d is any length.
    float radius = wN;
    vec3 f = ray.o - N;
    float a = dot(ray.d, ray.d), b = -dot(f, ray.d);
    vec3 nearest = f + (b / a) * ray.d;
    float discriminant = radius * radius - dot(nearest, nearest);
    float c = dot(f, f) - radius * radius;
    float q = b + (b < 0.0 ? -1.0 : 1.0) * sqrt(a * max(discriminant, 0.0));
    float t0 = c / q, t1 = q / a;
    // A ray that leaves the sphere itself meets it at t = 0 but for rounding: only the other root counts.
    bool leaves = same_baked(kind, id, ray.ignored);
    float lo = min(t0, t1), hi = max(t0, t1);
    lo = leaves ? (b > 0.0 ? hi : 0.0) : (lo > 0.0 ? lo : hi);
    bool hit = discriminant >= 0.0 && lo > 0.0 && lo < tmax && !is_target;
    return hit ? lo : tmax;
  }
  float t = -(dot(N, ray.o) + wN) * (1.0 / dot(N, ray.d));
  float s = (dot(A, ray.o) + wA) + t * dot(A, ray.d);
  float r = (dot(B, ray.o) + wB) + t * dot(B, ray.d);
  // All conditions in one number, negative inside: masks are dear where registers have none for them. A ray in the
  // plane has t infinite or NaN, and so is outside.
  float outside = larger(abs(s) - abs(h), abs(r) - abs(k));
  if (kind == kBakedTriangle) outside = larger(s * (1.0 / h) + r * (1.0 / k) - 1e-6, outside);
  outside = larger(outside, larger(-t, t - tmax));
  return outside < 0.0 && !is_target ? t : tmax;
}

// The ray between two parallel planes of a box: where it enters and leaves, through which faces.
void cross_slab(BakedRay ray, vec3 N, float w0, float w1, uint first_face, out float enter, out float leave,
                out uint enter_face, out uint leave_face) {
  float p = dot(N, ray.o), inverse = 1.0 / dot(N, ray.d);
  float t0 = (w0 - p) * inverse, t1 = (w1 - p) * inverse;
  enter = smaller(t0, t1);
  leave = larger(t0, t1);
  enter_face = inverse > 0.0 ? first_face : first_face + 1u;
  leave_face = enter_face ^ 1u;
}

// Smallest t in (0, tmax) at which the ray meets one of the box's `faces`, and which; tmax if it meets none. Kay and
// Kajiya 1986, "Ray Tracing Complex Scenes". Faces have no seams here.
float hit_box(BakedRay ray, float tmax, uint faces, vec3 N0, float w00, float w01, vec3 N1, float w10, float w11,
              vec3 N2, float w20, float w21, out uint face) {
  float enter, leave, enter1, leave1, enter2, leave2;
  uint enter_face, leave_face, enter_face1, leave_face1, enter_face2, leave_face2;
  cross_slab(ray, N0, w00, w01, 0u, enter, leave, enter_face, leave_face);
  cross_slab(ray, N1, w10, w11, 2u, enter1, leave1, enter_face1, leave_face1);
  cross_slab(ray, N2, w20, w21, 4u, enter2, leave2, enter_face2, leave_face2);
  enter_face = enter1 > enter ? enter_face1 : enter_face;
  enter = larger(enter1, enter);
  enter_face = enter2 > enter ? enter_face2 : enter_face;
  enter = larger(enter2, enter);
  leave_face = leave1 < leave ? leave_face1 : leave_face;
  leave = smaller(leave1, leave);
  leave_face = leave2 < leave ? leave_face2 : leave_face;
  leave = smaller(leave2, leave);
  bool enters = enter > 0.0, leaves = true;
  if (faces != 63u) {
    enters = enters && (faces >> enter_face & 1u) != 0u;
    leaves = (faces >> leave_face & 1u) != 0u;
  }
  face = enters ? enter_face : leave_face;
  float t = enters ? enter : leave;
  // A ray in the plane of a face has NaN there.
  return enter <= leave && t > 0.0 && t < tmax && (enters || leaves) ? t : tmax;
}

#define BAKED_BOX(a, b)                                                                                             \
  (baked_kind_##a##b >> kBakedFaceShift) & 63u, vec3(baked_nx_##a##b, baked_ny_##a##b, baked_nz_##a##b),             \
      baked_nw_##a##b, baked_h_##a##b, vec3(baked_ax_##a##b, baked_ay_##a##b, baked_az_##a##b), baked_aw_##a##b,     \
      baked_k_##a##b, vec3(baked_bx_##a##b, baked_by_##a##b, baked_bz_##a##b), baked_bw_##a##b,                      \
      uintBitsToFloat(baked_hit_##a##b)
#define BAKED_ARGUMENTS(a, b)                                                                                     \
  baked_hit_##a##b, baked_kind_##a##b, vec3(baked_nx_##a##b, baked_ny_##a##b, baked_nz_##a##b), baked_nw_##a##b,   \
      vec3(baked_ax_##a##b, baked_ay_##a##b, baked_az_##a##b), baked_aw_##a##b,                                   \
      vec3(baked_bx_##a##b, baked_by_##a##b, baked_bz_##a##b), baked_bw_##a##b, baked_h_##a##b, baked_k_##a##b

#define BAKED_CLOSEST(a, b)                                                    \
  if (baked_kind_##a##b != kBakedNone) {                                       \
    uint face = 0u;                                                            \
    float t;                                                                   \
    if ((baked_kind_##a##b & kBakedKindMask) == kBakedBox)                     \
      t = hit_box(ray, closest, BAKED_BOX(a, b), face);                        \
    else                                                                       \
      t = hit_baked(ray, closest, BAKED_ARGUMENTS(a, b));                      \
    primitive = t < closest ? (baked_kind_##a##b >> kBakedRowShift) + face : primitive; \
    closest = t;                                                               \
  }
// The rows (pairs of them) of what the ray meets first before `closest`, and where; kNoIndex if nothing.
uint closest_baked(BakedRay ray, inout float closest) {
  ray.ignored_target = 0xffffffffu;
  uint primitive = 0xffffffffu;
  BAKED_ALL(BAKED_CLOSEST)
  return primitive;
}

#define BAKED_ANY(a, b)                                                      \
  if (baked_kind_##a##b != kBakedNone && (baked_kind_##a##b & kBakedHull) == 0u) { \
    uint face;                                                               \
    if ((baked_kind_##a##b & kBakedKindMask) == kBakedBox)                   \
      blocked = blocked || hit_box(ray, tmax, BAKED_BOX(a, b), face) < tmax; \
    else                                                                     \
      blocked = blocked || hit_baked(ray, tmax, BAKED_ARGUMENTS(a, b)) < tmax; \
  }
bool any_baked(BakedRay ray, float tmax) {
  bool blocked = false;
  BAKED_ALL(BAKED_ANY)
  return blocked;
}

#endif
