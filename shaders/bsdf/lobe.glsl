// What evaluating and sampling a bsdf return; conventions in bsdf.glsl.
#ifndef TACHYLITE_BSDF_LOBE_GLSL
#define TACHYLITE_BSDF_LOBE_GLSL

const uint kLobeDelta = 1u;         // the direction has a Dirac delta: no light sampling finds it
const uint kLobeTransmission = 2u;  // wi is on the other side of the surface
const uint kLobeNull = 4u;          // straight on, as if nothing were there

struct BsdfEval {
  vec3 f;     // f |cos_wi| of the lobes without delta [1/sr]
  float pdf;  // of sample_..., w.r.t. solid angle of wi; 0 for delta lobes
};

struct BsdfSample {
  vec3 wi;
  vec3 weight;  // f |cos_wi| / pdf; 0: absorbed
  float pdf;    // w.r.t. solid angle; 0 for a delta lobe, and where sampling failed (absorbed, wi means nothing)
  uint flags;   // kLobe...
  float eta;    // index of refraction on the side of wi over that on the side of wo; 1 for reflection
};

const BsdfEval kNoEval = BsdfEval(vec3(0.0), 0.0);

BsdfSample absorbed() { return BsdfSample(vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, 0u, 1.0); }

#endif
