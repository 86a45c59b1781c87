// Sample points of paths: numbers that depend only on (seed, pixel, sample index, group), never on how or in which
// order paths are traced. The same bits in C++ and GLSL.
//
// Sobol: groups of 4 dimensions, each group the Owen-scrambled 4D Sobol sequence, padded to paths of any length by
// an Owen permutation of the sample index that differs from group to group (Burley 2020, "Practical Hash-based Owen
// Scrambling"). A permutation by XOR alone does not converge. The first 2^k samples of a pixel are a net in every
// group, for every k, and do not change with the number of samples that follow.
//
// Groups (fixed slots, so that a feature that is switched on never changes the samples of the others):
//   kGroupCamera                 pixel x, y; light point u, v of vertex 0
//   kGroupLens                   lens u, v; two spare
//   group_directions(k)          BSDF or phase direction u, v of vertex k; light point u, v of vertex k + 1
//   group_choices(k)             light selection, lobe selection, Russian roulette, spare; all of vertex k
//   group_medium(k)              of path segment k (k counts crossings of null surfaces, too): free flight distance,
//                                colour channel, two spare
//   group_extra(k)               four more of vertex k, for what needs them rarely
// where vertex 0 is the first that the camera ray meets. The pixel's position and the first light point share a group
// because direct light depends on both (3.6 times less error than two 2D groups at 1024 samples); a direction and
// the light point at its end do for the same reason. From kFirstHashedVertex on, samples are independent.
#ifndef TACHYLITE_SHARED_SAMPLER_H
#define TACHYLITE_SHARED_SAMPLER_H
#include "features.h"
#include "rng.h"
TACHYLITE_SHARED_BEGIN

TACHYLITE_CONST uint kGroupCamera = 0u;
TACHYLITE_CONST uint kGroupLens = 1u;
TACHYLITE_CONST uint kFirstVertexGroup = 4u;
TACHYLITE_CONST uint kGroupsPerVertex = 4u;
TACHYLITE_CONST uint kFirstHashedVertex = 8u;
TACHYLITE_INLINE uint group_directions(uint vertex) { return kFirstVertexGroup + kGroupsPerVertex * vertex; }
TACHYLITE_INLINE uint group_choices(uint vertex) { return kFirstVertexGroup + kGroupsPerVertex * vertex + 1u; }
TACHYLITE_INLINE uint group_medium(uint segment) { return kFirstVertexGroup + kGroupsPerVertex * segment + 2u; }
TACHYLITE_INLINE uint group_extra(uint vertex) { return kFirstVertexGroup + kGroupsPerVertex * vertex + 3u; }

/// The most samples a pixel can have: 2^kMaxSampleBits.
TACHYLITE_CONST uint kMaxSampleBits = 24u;

/// Bits of the indices of samples [0, end): the `bits` of sample_group.
TACHYLITE_INLINE uint sample_index_bits(uint end) {
  uint bits = 0u;
  for (uint rest = end > 1u ? end - 1u : 0u; rest != 0u; rest >>= 1u) bits++;
  return bits;
}

TACHYLITE_INLINE uint reverse_bits(uint x) {
#ifdef __cplusplus
  x = ((x >> 1u) & 0x55555555u) | ((x & 0x55555555u) << 1u);
  x = ((x >> 2u) & 0x33333333u) | ((x & 0x33333333u) << 2u);
  x = ((x >> 4u) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4u);
  x = ((x >> 8u) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8u);
  return (x >> 16u) | (x << 16u);
#else
  return bitfieldReverse(x);
#endif
}

/// Owen scrambling of bit-reversed fractions: every bit is flipped or not by a hash of the bits below it. Laine and
/// Karras 2011, with the constants of Vegdahl 2021, "Building a Better LK Hash".
TACHYLITE_INLINE uint scramble_reversed(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16u) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// An Owen permutation of the indices that maps [0, 2^k) to itself for every k: the XOR with the image of 0 undoes
/// the flips at the nodes above it, so that what is above the bits in use stays 0. index < 2^32.
TACHYLITE_INLINE uint permute_index(uint index, uint seed) {
  return reverse_bits(scramble_reversed(reverse_bits(index), seed) ^ scramble_reversed(0u, seed));
}

// Sobol dimensions 2 and 3: bit-reversed direction numbers; dimension 2 has the primitive polynomial x^2 + x + 1 and
// m = 1, 3, dimension 3 x^3 + x + 1 and m = 1, 3, 1 (Joe and Kuo 2008).
TACHYLITE_CONST uint kSobol2[24] = {
    0x00000001u, 0x00000003u, 0x00000006u, 0x00000009u, 0x00000017u, 0x0000003au, 0x00000071u, 0x000000a3u,
    0x00000116u, 0x00000339u, 0x00000677u, 0x000009aau, 0x00001601u, 0x00003903u, 0x00007706u, 0x0000aa09u,
    0x00010117u, 0x0003033au, 0x00060671u, 0x000909a3u, 0x00171616u, 0x003a3939u, 0x00717777u, 0x00a3aaaau};
TACHYLITE_CONST uint kSobol3[24] = {
    0x00000001u, 0x00000003u, 0x00000004u, 0x0000000au, 0x0000001fu, 0x0000002eu, 0x00000045u, 0x000000c9u,
    0x0000011bu, 0x000002a4u, 0x0000079au, 0x00000b67u, 0x0000101eu, 0x0000302du, 0x00004041u, 0x0000a0c3u,
    0x0001f104u, 0x0002e28au, 0x000457dfu, 0x000c9baeu, 0x0011a105u, 0x002a7289u, 0x0079e7dbu, 0x00b6dba4u};

/// Point `index` < 2^bits of the 4D Sobol sequence, bit-reversed; bits <= kMaxSampleBits.
TACHYLITE_INLINE uvec4 sobol_reversed(uint index, uint bits) {
  // Dimension 1 is Pascal's matrix modulo 2, as a butterfly.
  uint y = index;
  y ^= (y & 0xaaaaaaaau) >> 1u;
  y ^= (y & 0xccccccccu) >> 2u;
  y ^= (y & 0xf0f0f0f0u) >> 4u;
  y ^= (y & 0xff00ff00u) >> 8u;
  y ^= y >> 16u;
  uint z = 0u;
  uint w = 0u;
  for (uint b = 0u; b < bits; b++) {
    uint mask = 0u - ((index >> b) & 1u);
    z ^= mask & kSobol2[b];
    w ^= mask & kSobol3[b];
  }
  return uvec4(index, y, z, w);
}

/// The key of a pixel, for sample_group; `pixel` is any number of its own.
TACHYLITE_INLINE uint pixel_key(uint pixel, uint seed) { return hash_pair(pixel, seed); }

/// Four uniform 32-bit numbers (unit_float makes them floats) of a sample of a pixel, by kSamplerSobol, for groups
/// before those of kFirstHashedVertex. `index` counts the samples of the pixel, index < 2^bits; `bits` <= kMaxSampleBits
/// only shortens a loop (make it a constant): the numbers do not depend on it.
TACHYLITE_INLINE uvec4 sobol_group(uint key, uint index, uint group, uint bits) {
  uint seed = hash_pair(key, group);
  uvec4 x = sobol_reversed(permute_index(index, seed), bits);
  return uvec4(reverse_bits(scramble_reversed(x.x, hash_pcg(seed + 1u))),
               reverse_bits(scramble_reversed(x.y, hash_pcg(seed + 2u))),
               reverse_bits(scramble_reversed(x.z, hash_pcg(seed + 3u))),
               reverse_bits(scramble_reversed(x.w, hash_pcg(seed + 4u))));
}

/// The same of any group. `kind` is a kSampler...; from kFirstHashedVertex on, kSamplerSobol gives the numbers of
/// kSamplerIndependent.
TACHYLITE_INLINE uvec4 sample_group(uint kind, uint key, uint index, uint group, uint bits) {
  if (kind == kSamplerIndependent || group >= kFirstVertexGroup + kGroupsPerVertex * kFirstHashedVertex)
    return hash_pcg4d(uvec4(key, index, group, 0x7ac41u));
  return sobol_group(key, index, group, bits);
}

TACHYLITE_INLINE vec4 unit_float4(uvec4 bits) {
  return vec4(unit_float(bits.x), unit_float(bits.y), unit_float(bits.z), unit_float(bits.w));
}

TACHYLITE_SHARED_END
#endif
