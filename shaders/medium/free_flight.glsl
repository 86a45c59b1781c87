// Outcome of a flight through a medium to the end of a segment.
#ifndef TACHYLITE_MEDIUM_FREE_FLIGHT_GLSL
#define TACHYLITE_MEDIUM_FREE_FLIGHT_GLSL

struct FreeFlight {
  bool collides;
  float t;    // of the collision
  vec3 beta;  // throughput after it: at a collision sigma_s T / density, at the end T / probability
};

#endif
