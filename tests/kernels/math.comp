#version 460
#extension GL_GOOGLE_include_directive : require
// y[i] = f(x[i].x, x[i].y); f by a specialization constant, in the order of math_test.cpp.
#include "base/math.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kFunction = 0u;
layout(push_constant) uniform Push { uint count; };
layout(set = 0, binding = 0) readonly buffer In { vec2 x[]; };
layout(set = 0, binding = 1) writeonly buffer Out { float y[]; };

float f(vec2 v) {
  switch (kFunction) {
    case 0u: return xexp(v.x);
    case 1u: return xexpm1(v.x);
    case 2u: return xlog(v.x);
    case 3u: return xlog1p(v.x);
    case 4u: return xacos(v.x);
    case 5u: return xasin(v.x);
    case 6u: return xatan2(v.y, v.x);
    case 7u: return xerf(v.x);
    case 8u: return xerfinv(v.x);
    case 9u: return cos_sin_turns(v.x).x;
    case 10u: return cos_sin_turns(v.x).y;
    case 11u: return difference_of_products(v.x, v.x, v.y, v.y);
    case 12u: return is_nan(v.x) ? 1.0 : (is_finite(v.x) ? 0.0 : 2.0);
    case 13u: return safe_sqrt(v.x);
    case 14u: return v.x + v.y;
    default: return 0.0;
  }
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < count) y[i] = f(x[i]);
}
