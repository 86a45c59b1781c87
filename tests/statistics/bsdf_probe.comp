// Samples and evaluates one bsdf per invocation in the frame s = x, t = y, n = z; for the tests of shaders/bsdf.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bsdf/bsdf.glsl"

layout(push_constant) uniform Push { uint count; };
struct Query {
  vec4 wo;  // xyz; w: bits of the material's row
  vec4 wi;  // xyz: where to evaluate; zero: in the sampled direction
  vec4 u;   // u, u_lobe; w: u coordinate of the texture point (v = 1/2)
};
struct Answer {
  vec4 wi;      // sampled; pdf
  vec4 weight;  // of the sample; eta
  vec4 f;       // evaluated; pdf
  vec4 null_transmission;  // xyz; bits of the sample's flags
};
layout(std430, set = 0, binding = 30) readonly buffer Queries { Query queries[]; };
layout(std430, set = 0, binding = 31) writeonly buffer Answers { Answer answers[]; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  Query query = queries[i];
  Interaction it;
  it.p = it.p_error = vec3(0.0);
  it.n_g = it.n_s = vec3(0.0, 0.0, 1.0);
  it.s = it.dp_du = vec3(1.0, 0.0, 0.0);
  it.t = it.dp_dv = vec3(0.0, 1.0, 0.0);
  it.point = TexturePoint(vec2(query.u.w, 0.5), 0u, vec2(0.0));
  it.shape = it.light = 0u;
  it.material = floatBitsToUint(query.wo.w);
  SurfaceBsdf b = load_bsdf(it, query.wo.xyz);
  BsdfSample s = sample_bsdf(b, query.u.xy, query.u.z);
  BsdfEval eval = eval_bsdf(b, query.wi.xyz == vec3(0.0) ? s.wi : query.wi.xyz);
  vec3 passes = null_transmission_bsdf(it.material, it.point, it.n_s, query.wo.xyz);
  answers[i] = Answer(vec4(s.wi, s.pdf), vec4(s.weight, s.eta), vec4(eval.f, eval.pdf),
                      vec4(passes, uintBitsToFloat(s.flags)));
}
