// What a shading kernel knows of the point that a ray has hit.
#ifndef TACHYLITE_GEOMETRY_INTERACTION_GLSL
#define TACHYLITE_GEOMETRY_INTERACTION_GLSL

// Where on a surface a texture is looked up.
struct TexturePoint {
  vec2 uv;
  uint primitive;     // triangle, for mesh attributes
  vec2 barycentrics;  // of vertices 1 and 2 of that triangle
};

// n_g and n_s are unit and point to the outside of the shape (flip_normals applied). The shading frame is
// s = normalize(dp_du - n_s dot(n_s, dp_du)), t = cross(n_s, s), as Mitsuba's; without need for a tangent
// (kMaterialTangent) s is any unit vector orthogonal to n_s and dp_du, dp_dv are undefined.
struct Interaction {
  vec3 p;             // device space, computed from barycentrics
  vec3 p_error;       // bound of the absolute error of p
  vec3 n_g;
  vec3 n_s, s, t;
  vec3 dp_du, dp_dv;
  TexturePoint point;
  uint shape;         // row in kBindShapes
  uint material;      // row in kBindMaterials
  uint light;         // row in kBindLights, kNoIndex when it does not emit
};

#endif
