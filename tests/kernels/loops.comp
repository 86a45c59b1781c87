#version 460
#extension GL_GOOGLE_include_directive : require
// Forms of a loop that lanes leave at different times with a value: found[i] = table[k] of the first k with
// table[k] >= limit[i], by the form that kForm says. Mesa 22.3.6 gives the lanes that leave early the value of a
// later iteration in form 0, where a value of the body leaves an endless loop through break (a load of the lanes that
// have left overwrites it). All the others must be right on every driver: they are what our kernels may use.
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kForm = 0u;
layout(push_constant) uniform Push { uint count; uint table_size; };
layout(set = 0, binding = 0) readonly buffer Limits { uint limit[]; };
layout(set = 0, binding = 1) writeonly buffer Found { uint found[]; };
layout(set = 0, binding = 2) readonly buffer Table { uint table[]; };

uint load(uint k) { return table[k]; }

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  const uint least = limit[i];
  uint r = 0u;
  if (kForm == 0u) {  // wrong on 22.3.6
    uint k = 0u;
    while (true) {
      const uint v = load(k);
      if (v >= least) {
        r = v;
        break;
      }
      k++;
    }
  } else if (kForm == 1u) {  // condition at the head
    bool go = true;
    for (uint k = 0u; go && k < table_size; k++) {
      r = load(k);
      go = r < least;
    }
  } else if (kForm == 2u) {  // the value in a variable that every iteration carries on
    for (uint k = 0u; k < table_size; k++) {
      const uint v = load(k);
      const bool done = v >= least;
      r += done ? v : 0u;
      if (done) break;
    }
  } else if (kForm == 3u) {  // only the index leaves the loop
    uint k = 0u;
    for (; k < table_size; k++)
      if (load(k) >= least) break;
    r = load(k);
  } else {  // guarded, no break
    bool done = false;
    for (uint k = 0u; k < table_size && !done; k++) {
      const uint v = load(k);
      if (v >= least) {
        r = v;
        done = true;
      }
    }
  }
  found[i] = r;
}
