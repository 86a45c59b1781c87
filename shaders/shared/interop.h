// Lets one header serve GLSL and C++: the same names for the same 4-byte words. Only 4-byte scalars and 16-byte
// vectors are used in records, so that layouts agree without padding rules.
#ifndef TACHYLITE_SHARED_INTEROP_H
#define TACHYLITE_SHARED_INTEROP_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace tachylite::gpu {
using uint = std::uint32_t;
using glm::ivec4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
}  // namespace tachylite::gpu
#define TACHYLITE_SHARED_BEGIN namespace tachylite::gpu {
#define TACHYLITE_SHARED_END }
#define TACHYLITE_CONST constexpr
#define TACHYLITE_INLINE inline
#else
#define TACHYLITE_SHARED_BEGIN
#define TACHYLITE_SHARED_END
#define TACHYLITE_CONST const
#define TACHYLITE_INLINE
#endif

#endif
