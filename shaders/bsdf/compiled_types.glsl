// Which types of bsdf this kernel has in its SPIR-V. Specialization removes what a class lacks, but only after the
// driver has read, inlined and optimised all of it: 3 s of CPU time on lavapipe for all types, 0.1 s for one. So
// kernels come in variants (shaders/CMakeLists.txt): one for each type, and one with all types for mixtures.
//
// BSDF_TYPES: set of 1 << kBsdf...; all when it is not defined. IF_TYPE(code) is code where the type is in the set.
#ifndef TACHYLITE_BSDF_COMPILED_TYPES_GLSL
#define TACHYLITE_BSDF_COMPILED_TYPES_GLSL

#ifndef BSDF_TYPES
#define BSDF_TYPES 0xffff
#endif

#if (BSDF_TYPES & 2) != 0
#include "bsdf/diffuse.glsl"
#define IF_DIFFUSE(code) code
#else
#define IF_DIFFUSE(code)
#endif
#if (BSDF_TYPES & 4) != 0
#include "bsdf/rough_diffuse.glsl"
#define IF_ROUGH_DIFFUSE(code) code
#else
#define IF_ROUGH_DIFFUSE(code)
#endif
#if (BSDF_TYPES & 8) != 0
#include "bsdf/conductor.glsl"
#define IF_CONDUCTOR(code) code
#else
#define IF_CONDUCTOR(code)
#endif
#if (BSDF_TYPES & 16) != 0
#include "bsdf/rough_conductor.glsl"
#define IF_ROUGH_CONDUCTOR(code) code
#else
#define IF_ROUGH_CONDUCTOR(code)
#endif
#if (BSDF_TYPES & 32) != 0
#include "bsdf/dielectric.glsl"
#define IF_DIELECTRIC(code) code
#else
#define IF_DIELECTRIC(code)
#endif
#if (BSDF_TYPES & 64) != 0
#include "bsdf/thin_dielectric.glsl"
#define IF_THIN_DIELECTRIC(code) code
#else
#define IF_THIN_DIELECTRIC(code)
#endif
#if (BSDF_TYPES & 128) != 0
#include "bsdf/rough_dielectric.glsl"
#define IF_ROUGH_DIELECTRIC(code) code
#else
#define IF_ROUGH_DIELECTRIC(code)
#endif
#if (BSDF_TYPES & 256) != 0
#include "bsdf/plastic.glsl"
#define IF_PLASTIC(code) code
#else
#define IF_PLASTIC(code)
#endif
#if (BSDF_TYPES & 512) != 0
#include "bsdf/rough_plastic.glsl"
#define IF_ROUGH_PLASTIC(code) code
#else
#define IF_ROUGH_PLASTIC(code)
#endif
#if (BSDF_TYPES & 1024) != 0
#include "bsdf/principled.glsl"
#define IF_PRINCIPLED(code) code
#else
#define IF_PRINCIPLED(code)
#endif
#if (BSDF_TYPES & 2048) != 0
#include "bsdf/principled_thin.glsl"
#define IF_PRINCIPLED_THIN(code) code
#else
#define IF_PRINCIPLED_THIN(code)
#endif
#if (BSDF_TYPES & 4096) != 0
#include "bsdf/blinn_phong.glsl"
#define IF_BLINN_PHONG(code) code
#else
#define IF_BLINN_PHONG(code)
#endif
#if (BSDF_TYPES & 8192) != 0
#include "bsdf/nori_microfacet.glsl"
#define IF_MICROFACET(code) code
#else
#define IF_MICROFACET(code)
#endif

#endif
