// Path state and queues as kernels use them: writes through storage buffers, reads as base/rows.glsl says.
#ifndef TACHYLITE_BASE_QUEUES_GLSL
#define TACHYLITE_BASE_QUEUES_GLSL
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "base/features.glsl"
#include "base/math.glsl"
#include "base/rows.glsl"
#include "shared/bindings.h"
#include "shared/bvh.h"
#include "shared/counters.h"
#include "shared/path_state.h"
#include "shared/render_params.h"

// Only kernels with wide rows read from storage buffers.
#ifdef WIDE_ROWS
#define WRITTEN
#else
#define WRITTEN writeonly
#endif

layout(set = 0, binding = kBindParams) uniform RenderParamsBlock { RenderParams params; };
layout(set = 0, binding = kBindPathTexels) uniform samplerBuffer path_texels;
// Rows and pairs of rows are two views of the same memory, and so not restrict.
layout(set = 0, binding = kBindPaths) WRITTEN buffer Paths { ROW path_rows[]; };
layout(set = 0, binding = kBindPaths) writeonly buffer PathPairs { ROW_PAIR path_pairs[]; };
layout(set = 0, binding = kBindQueueTexels) uniform usamplerBuffer queue_texels;
layout(set = 0, binding = kBindQueues) WRITTEN restrict buffer Queues { uint queue_entries[]; };
layout(set = 0, binding = kBindShadowTexels) uniform samplerBuffer shadow_texels;
layout(set = 0, binding = kBindShadow) WRITTEN buffer Shadow { ROW shadow_rows[]; };
layout(set = 0, binding = kBindShadow) writeonly buffer ShadowPairs { ROW_PAIR shadow_pairs[]; };
layout(set = 0, binding = kBindCounters) restrict buffer Counters { uint counters[]; };
layout(set = 0, binding = kBindPixelList) uniform usamplerBuffer pixel_list;

layout(push_constant) uniform Wave { WaveParams wave; };

// Rows 0 and 1 lie side by side.
uint row_index(uint row, uint i) { return row < 2u ? 2u * i + row : row * params.capacity + i; }

vec4 load_path(uint row, uint slot) {
  uint i = row_index(row, slot);
  return STORED_OR_FETCHED(uintBitsToFloat(unpack_row(path_rows[i])), texelFetch(path_texels, int(i)));
}
vec4 load_shadow(uint row, uint place) {
  uint i = row_index(row, place);
  return STORED_OR_FETCHED(uintBitsToFloat(unpack_row(shadow_rows[i])), texelFetch(shadow_texels, int(i)));
}
uint load_queue(uint queue, uint entry) {
  uint i = queue * params.capacity + entry;
  return STORED_OR_FETCHED(queue_entries[i], texelFetch(queue_texels, int(i)).x);
}

void store_path(uint row, uint slot, vec4 value) { path_rows[row_index(row, slot)] = pack_row(value); }
// leaving: bits of the hit that the ray leaves; pdf: of d.
void store_path_ray(uint slot, vec3 o, uint leaving, vec3 d, float pdf) {
  path_pairs[slot] = pack_rows(vec4(o, uintBitsToFloat(leaving)), vec4(d, pdf));
}

// Word of the length of a queue, at a bounce.
uint length_word(uint queue, uint bounce) {
  return kCounterQueue + queue + (queue >= kQueueEmitter && (bounce & 1u) != 0u ? kMaxQueues : 0u);
}
uint queue_length(uint queue) { return counters[length_word(queue, wave.bounce)]; }
void store_queue(uint queue, uint i, uint slot) { queue_entries[queue * params.capacity + i] = slot; }
uint place_of(uint queue, uint i) { return counters[kCounterPlace + queue] + i; }

void store_shadow_ray(uint place, vec3 o, uint leaving, vec3 d, uint target, vec3 contribution, uint slot) {
  shadow_pairs[place] = pack_rows(vec4(o, uintBitsToFloat(leaving)), vec4(d, uintBitsToFloat(target)));
  shadow_rows[row_index(2u, place)] = pack_row(vec4(contribution, uintBitsToFloat(slot)));
}

// Adds to the radiance of a path; what is not finite is dropped and counted. Only one lane at a time owns a path.
void add_radiance(uint slot, vec3 value) {
  if (is_finite(value)) {
    vec4 radiance = load_path(kPathRadiance, slot);
    store_path(kPathRadiance, slot, vec4(radiance.xyz + value, radiance.w));
  } else {
    atomicAdd(counters[kCounterNonfinite], 1u);
  }
}

// The host fails on it.
void report_unfinished(bool unfinished) {
  if (unfinished) atomicAdd(counters[kCounterUnfinished], 1u);
}

// Adds a count of each lane to one of the wave.
void add_to_counter(uint counter, uint count) {
  uint sum = subgroupAdd(count);
  if (subgroupElect() && sum > 0u) atomicAdd(counters[counter], sum);
}

// n / d for n < 2^24 and 0 < d < 2^24: lavapipe divides integers lane by lane.
uint divide(uint n, uint d) {
  uint q = uint(float(n) / float(d));
  int rest = int(n - q * d);
  return rest < 0 ? q - 1u : (rest >= int(d) ? q + 1u : q);
}

// Pixel of the image for a pixel in tile order; false outside.
bool pixel_of(uint tile_pixel, out uvec2 pixel) {
  uint tile = tile_pixel / (kTileSize * kTileSize), inner = tile_pixel % (kTileSize * kTileSize);
  uint row = divide(tile, params.tiles_x);
  pixel = uvec2(tile - row * params.tiles_x, row) * kTileSize +
          uvec2(inner % kTileSize, inner / kTileSize);
  return pixel.x < params.width && pixel.y < params.height;
}

// Number of a pixel of the image in the full film: what its samples depend on.
// Photons have numbers of their own.
uint film_pixel(uvec2 pixel) {
  uint number = (pixel.y + params.crop_y) * params.film_width + pixel.x + params.crop_x;
  return wave.photons != 0u ? ~(pixel.y << 16u | pixel.x) : number;
}

// Pixel i of the wave: its number in tile order, and its first block.
uint wave_pixel(uint i) { return has_pixel_list ? texelFetch(pixel_list, int(i)).x : wave.first_pixel + i; }
uint wave_block(uint i) { return has_pixel_list ? texelFetch(pixel_list, int(i)).y : wave.first_block; }

// Pixel (in tile order) and sample index of a path slot.
uint slot_tile_pixel(uint slot) {
  uint i = slot / kBlockSamples;
  return wave_pixel(i - divide(i, wave.pixel_count) * wave.pixel_count);
}
uint slot_sample(uint slot) {
  uint i = slot / kBlockSamples, block = divide(i, wave.pixel_count);
  return (wave_block(i - block * wave.pixel_count) + block) * kBlockSamples + slot % kBlockSamples;
}

#endif
