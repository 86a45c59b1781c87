// What a kernel is compiled for: ids of the specialization constants. host/pack/feature_set fills them from the
// scene; base/features.glsl declares them for the kernels.
#ifndef TACHYLITE_SHARED_FEATURES_H
#define TACHYLITE_SHARED_FEATURES_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

// Geometry
TACHYLITE_CONST uint kFeatureCurved = 0u;         // bool: spheres, disks or cylinders
TACHYLITE_CONST uint kFeatureVertexNormals = 1u;  // bool
TACHYLITE_CONST uint kFeatureVertexUv = 2u;       // bool: some texture reads the uv of meshes
TACHYLITE_CONST uint kFeatureClassCount = 3u;     // uint: material classes = surface queues
// Camera, film, sampler
TACHYLITE_CONST uint kFeatureCamera = 4u;         // uint: kCamera...
TACHYLITE_CONST uint kFeatureFilter = 5u;         // uint: kFilter...
TACHYLITE_CONST uint kFeatureSampler = 6u;        // uint: kSampler...
TACHYLITE_CONST uint kFeatureLog2Samples = 7u;    // uint: at most 2^this samples a pixel
// Paths
TACHYLITE_CONST uint kFeatureMaxDepth = 8u;       // uint: edges; 0xffffffff is unlimited
TACHYLITE_CONST uint kFeatureRouletteDepth = 9u;  // uint: first depth with Russian roulette; >= max depth: none
TACHYLITE_CONST uint kFeatureHideEmitters = 10u;  // bool
TACHYLITE_CONST uint kFeatureStrategy = 11u;      // uint: kStrategy...
// Lights
TACHYLITE_CONST uint kFeatureLights = 12u;        // uint: set of 1 << kLight...
TACHYLITE_CONST uint kFeatureSelection = 13u;     // uint: kSelect...
TACHYLITE_CONST uint kFeatureLightTextures = 14u; // bool: some light's radiance is a texture
// Textures
TACHYLITE_CONST uint kFeatureTextures = 15u;      // uint: set of kTexture... kinds, formats, filters, wraps in use
// The material class of a shade_surface kernel
TACHYLITE_CONST uint kFeatureBsdfs = 16u;         // uint: set of 1 << kBsdf...
TACHYLITE_CONST uint kFeatureMaterial = 17u;      // uint: kMaterial... flags
TACHYLITE_CONST uint kFeatureMaxLeaves = 18u;     // uint
TACHYLITE_CONST uint kFeatureClass = 19u;         // uint: which queue
TACHYLITE_CONST uint kFeatureTexturedInputs = 23u; // uint: which inputs of the class's leaves may be textures
// Media
TACHYLITE_CONST uint kFeatureMedia = 20u;         // uint: set of kMedia...; 0: none
TACHYLITE_CONST uint kFeatureShadowNull = 21u;    // bool: shadow rays pass null surfaces
TACHYLITE_CONST uint kFeatureAov = 22u;           // uint: set of AOVs
TACHYLITE_CONST uint kFeatureTriangles = 24u;     // bool
TACHYLITE_CONST uint kFeaturePixelList = 25u;     // bool: adaptive sampling, a wave's pixels are listed
TACHYLITE_CONST uint kFeatureGuide = 26u;         // bool: directions on this class of diffuse surfaces are guided
TACHYLITE_CONST uint kFeaturePhotons = 27u;       // bool: the paths are photons that the guide learns from
TACHYLITE_CONST uint kFeatureWalls = 28u;         // bool: large parallelograms outside of the tree
TACHYLITE_CONST uint kFeatureFocusers = 29u;      // uint: spheres of the guide
TACHYLITE_CONST uint kFeatureCameraMedium = 30u;  // uint: the medium that the camera is in
TACHYLITE_CONST uint kFeatureStorageReads = 31u;  // bool: kernels with wide rows read tree and paths from storage buffers

TACHYLITE_CONST uint kCameraPerspective = 0u;
TACHYLITE_CONST uint kCameraThinLens = 1u;
TACHYLITE_CONST uint kCameraOrthographic = 2u;
TACHYLITE_CONST uint kFilterBox = 0u;
TACHYLITE_CONST uint kFilterTent = 1u;
TACHYLITE_CONST uint kFilterGaussian = 2u;
TACHYLITE_CONST uint kSamplerSobol = 0u;
TACHYLITE_CONST uint kSamplerIndependent = 1u;
TACHYLITE_CONST uint kStrategyMis = 0u;
TACHYLITE_CONST uint kStrategyEmitter = 1u;
TACHYLITE_CONST uint kStrategyBsdf = 2u;

// Kinds of lights.
TACHYLITE_CONST uint kLightTriangles = 0u;     // area light on triangles (meshes, cubes)
TACHYLITE_CONST uint kLightRectangle = 1u;     // area light on a parallelogram with right angles
TACHYLITE_CONST uint kLightSphere = 2u;
TACHYLITE_CONST uint kLightDisk = 3u;
TACHYLITE_CONST uint kLightCylinder = 4u;
TACHYLITE_CONST uint kLightConstant = 5u;
TACHYLITE_CONST uint kLightEnvironment = 6u;
TACHYLITE_CONST uint kLightPoint = 7u;
TACHYLITE_CONST uint kLightDirectional = 8u;
TACHYLITE_CONST uint kLightSpot = 9u;
TACHYLITE_CONST uint kLightProjector = 10u;
TACHYLITE_CONST uint kLightDirectionalArea = 11u;
// How a light is chosen.
TACHYLITE_CONST uint kSelectNone = 0u;         // no light can be sampled
TACHYLITE_CONST uint kSelectSingle = 1u;       // one light: no random number
TACHYLITE_CONST uint kSelectLoop = 2u;         // a few: importance of each at the point
TACHYLITE_CONST uint kSelectTree = 3u;         // many

TACHYLITE_SHARED_END
#endif
