#include "load_support.h"

#include <fmt/format.h>

namespace tachylite {
namespace {

constexpr const char* kSphere = "<shape type=\"sphere\"/>";

using LoadScene = LoadTest;

TEST_F(LoadScene, ParametersWinOverDefaults) {
  const std::string xml =
      "<scene version=\"3.0.0\"><default name=\"n\" value=\"16\"/><default name=\"nx\" value=\"8\"/>"
      "<sensor type=\"perspective\"><sampler type=\"independent\"><integer name=\"sample_count\" "
      "value=\"$n\"/></sampler>"
      "<film type=\"hdrfilm\"><integer name=\"width\" value=\"$nx\"/><integer name=\"height\" "
      "value=\"$nx2\"/></film>"
      "</sensor><emitter type=\"constant\"/></scene>";
  const Scene plain = load(xml);
  EXPECT_EQ(plain.sensors[0].sample_count, 16);
  EXPECT_EQ(plain.sensors[0].film.width, 8);
  EXPECT_EQ(plain.sensors[0].film.height, 82);  // $nx, then "2"
  LoadOptions options;
  options.parameters = {{"n", "64"}};
  EXPECT_EQ(load(xml, options).sensors[0].sample_count, 64);
}

TEST_F(LoadScene, IncludesAndPaths) {
  write("parts/light.xml",
        "<scene version=\"0.6.0\"><default name=\"watt\" value=\"7\"/>"
        "<emitter type=\"point\"><spectrum name=\"intensity\" value=\"$watt\"/></emitter></scene>");
  write("parts/ball.xml",
        "<shape type=\"obj\" version=\"3.0.0\"><string name=\"filename\" value=\"tri.obj\"/></shape>");
  write("models/tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene scene = load(
      "<scene version=\"3.0.0\"><path value=\"models\"/><sensor type=\"perspective\"/>"
      "<include filename=\"parts/light.xml\"/>\n<include filename=\"parts/ball.xml\"/></scene>");
  EXPECT_EQ(only<PointEmitter>(scene.emitters).intensity, dvec3(7));
  EXPECT_EQ(std::get<MeshShape>(scene.shapes[0].kind).mesh->triangles.size(), 1);
  EXPECT_TRUE(scene.emitters[0].where.str().ends_with("parts/light.xml:1"));
}

TEST_F(LoadScene, ReferencesAreSharedAndMayComeFirst) {
  const Scene scene = load_body(
      "<shape type=\"sphere\"><ref id=\"other\"/></shape><shape type=\"cube\"><ref id=\"red\"/></shape>"
      "<bsdf type=\"diffuse\" id=\"red\"/><alias id=\"red\" as=\"other\"/><bsdf type=\"plastic\" "
      "id=\"unused\"/>");
  EXPECT_EQ(scene.shapes[0].bsdf, scene.shapes[1].bsdf);
  ASSERT_EQ(scene.bsdfs.size(), 1);  // what nothing refers to is not kept
  EXPECT_EQ(scene.bsdfs[0].id, "red");
}

TEST_F(LoadScene, UnusedObjectsAreCheckedAllTheSame) {
  const std::string unused =
      "<bsdf type=\"diffuse\" id=\"x\"><float name=\"reflectance\" value=\"two\"/></bsdf>";
  EXPECT_THROW(load_body(unused + kSphere), InputError);
}

TEST_F(LoadScene, ShapesWithoutBsdf) {
  const Scene scene =
      load_body("<shape type=\"sphere\"/><shape type=\"disk\"><emitter type=\"area\"/></shape>");
  const auto reflectance = [&](int shape) {
    return std::get<DiffuseBsdf>(
               scene.bsdfs[static_cast<size_t>(scene.shapes[static_cast<size_t>(shape)].bsdf)].kind)
        .reflectance.value;
  };
  EXPECT_EQ(reflectance(0), dvec3(0.5));
  EXPECT_EQ(reflectance(1), dvec3(0));
  EXPECT_EQ(scene.shapes[1].emitter, 1);
  EXPECT_EQ(scene.emitters[1].shape, 1);
}

TEST_F(LoadScene, FieldsOfView) {
  const auto x_fov = [&](const std::string& parameters) {
    return glm::degrees(
        load("<scene version=\"3.0.0\"><sensor type=\"perspective\">" + parameters +
             "<film type=\"hdrfilm\"><integer name=\"width\" value=\"200\"/>"
             "<integer name=\"height\" value=\"100\"/></film></sensor><emitter type=\"constant\"/></scene>")
            .sensors[0]
            .x_fov);
  };
  const std::string fov = "<float name=\"fov\" value=\"60\"/><string name=\"fov_axis\" value=\"";
  const double y_as_x = glm::degrees(2 * std::atan(2 * std::tan(glm::radians(30.0))));
  EXPECT_NEAR(x_fov("<float name=\"fov\" value=\"60\"/>"), 60, 1e-12);
  EXPECT_NEAR(x_fov(fov + "y\"/>"), y_as_x, 1e-12);
  EXPECT_NEAR(x_fov(fov + "smaller\"/>"), y_as_x, 1e-12);
  EXPECT_NEAR(x_fov(fov + "larger\"/>"), 60, 1e-12);
  // Half the diagonal is tan 30; half the width is 2/sqrt(5) of it.
  EXPECT_NEAR(x_fov(fov + "diagonal\"/>"),
              glm::degrees(2 * std::atan(std::tan(glm::radians(30.0)) * 2 / std::sqrt(5))), 1e-12);
  // 50 mm on 36 x 24: half the diagonal is 21.633 / 50.
  EXPECT_NEAR(x_fov(""), glm::degrees(2 * std::atan(0.4326661530556787 * 2 / std::sqrt(5))), 1e-12);
}

TEST_F(LoadScene, Films) {
  const Scene scene = load(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><sensor type=\"orthographic\" "
      "id=\"second\"><film type=\"hdrfilm\">"
      "<integer name=\"width\" value=\"64\"/><integer name=\"height\" value=\"48\"/>"
      "<integer name=\"crop_offset_x\" value=\"10\"/><integer name=\"crop_width\" value=\"20\"/>"
      "<string name=\"pixel_format\" value=\"rgb\"/><rfilter type=\"tent\"><float name=\"radius\" "
      "value=\"1.5\"/></rfilter>"
      "</film></sensor><emitter type=\"constant\"/></scene>");
  const Film& plain = scene.sensors[0].film;
  EXPECT_EQ(plain.width, 768);
  EXPECT_EQ(plain.crop_height, 576);
  EXPECT_EQ(plain.filter, ReconstructionFilter::kGaussian);
  EXPECT_EQ(plain.filter_radius, 2);
  const Film& film = scene.sensors[1].film;
  EXPECT_EQ(scene.sensors[1].id, "second");
  EXPECT_EQ(film.crop_x, 10);
  EXPECT_EQ(film.crop_width, 20);
  EXPECT_EQ(film.crop_height, 48);
  EXPECT_EQ(film.filter, ReconstructionFilter::kTent);
  EXPECT_EQ(film.filter_radius, 1.5);
}

TEST_F(LoadScene, Integrators) {
  const auto integrator = [&](const std::string& xml) { return load_body(xml + kSphere).integrator; };
  EXPECT_EQ(integrator("").kind, Integrator::Kind::kPath);
  const Integrator wrapped = integrator(
      "<integrator type=\"aov\"><string name=\"aovs\" value=\"a:albedo, dd.y:depth\"/><integrator "
      "type=\"moment\">"
      "<integrator type=\"volpathmis\"><integer name=\"max_depth\" "
      "value=\"7\"/></integrator></integrator></integrator>");
  EXPECT_EQ(wrapped.kind, Integrator::Kind::kVolpathMis);
  EXPECT_EQ(wrapped.max_depth, 7);
  EXPECT_TRUE(wrapped.moment);
  EXPECT_EQ(wrapped.aovs, (std::vector<std::string>{"a:albedo", "dd.y:depth"}));
  const Integrator direct =
      integrator("<integrator type=\"direct\"><integer name=\"bsdf_samples\" value=\"0\"/></integrator>");
  EXPECT_EQ(direct.strategy, Integrator::Strategy::kEmitterOnly);
  for (const char* type : {"direct", "path", "volpath", "volpathmis"}) {
    const auto sampling = [&](const char* word) {
      return integrator(fmt::format(
                            "<integrator type=\"{}\"><string name=\"sampling\" value=\"{}\"/></integrator>", type, word))
          .strategy;
    };
    EXPECT_EQ(sampling("mis"), Integrator::Strategy::kMis);
    EXPECT_EQ(sampling("emitter"), Integrator::Strategy::kEmitterOnly);
    EXPECT_EQ(sampling("bsdf"), Integrator::Strategy::kBsdfOnly);
  }
}

TEST_F(LoadScene, Emitters) {
  const Scene scene = load(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>"
      "<emitter type=\"point\"><transform name=\"to_world\"><translate x=\"3\"/></transform></emitter>"
      "<emitter type=\"directional\"><transform name=\"to_world\"><lookat origin=\"0,5,0\" target=\"0,0,0\" "
      "up=\"1,0,0\"/>"
      "</transform></emitter>"
      "<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"40\"/></emitter></scene>");
  EXPECT_EQ(only<PointEmitter>(scene.emitters).position, dvec3(3, 0, 0));
  expect_near(only<DirectionalEmitter>(scene.emitters).direction, {0, -1, 0}, 1e-15);
  EXPECT_NEAR(only<SpotEmitter>(scene.emitters).beam_width, glm::radians(30.0), 1e-15);
}

TEST_F(LoadScene, BsdfDefaultsAndNesting) {
  const auto load_bsdf = [&](const std::string& bsdf, const std::string& version = "3.0.0") {
    return load_body("<shape type=\"sphere\">" + bsdf + "</shape>", version).bsdfs;
  };
  EXPECT_NEAR(only<DielectricBsdf>(load_bsdf("<bsdf type=\"dielectric\"/>")).eta, 1.5046 / 1.000277, 1e-15);
  EXPECT_NEAR(
      only<PlasticBsdf>(load_bsdf("<bsdf type=\"plastic\"><string name=\"int_ior\" value=\"Diamond\"/>"
                                  "<float name=\"ext_ior\" value=\"1\"/></bsdf>"))
          .eta,
      2.419, 1e-15);
  EXPECT_NEAR(only<PrincipledBsdf>(load_bsdf("<bsdf type=\"principled\"/>")).eta, 1.5, 1e-12);
  EXPECT_EQ(only<ConductorBsdf>(load_bsdf("<bsdf type=\"conductor\"/>")).k.value, dvec3(1));
  const auto nested = load_bsdf(
      "<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.25\"/><bsdf type=\"twosided\"><bsdf "
      "type=\"diffuse\"/>"
      "<bsdf type=\"roughconductor\"><float name=\"alpha_u\" value=\"0.1\"/><float name=\"alpha_v\" "
      "value=\"0.3\"/>"
      "<string name=\"material\" value=\"Au\"/></bsdf></bsdf></bsdf>");
  const auto& twosided =
      std::get<TwoSidedBsdf>(nested[static_cast<size_t>(only<MaskBsdf>(nested).child)].kind);
  EXPECT_TRUE(std::holds_alternative<DiffuseBsdf>(nested[static_cast<size_t>(twosided.front)].kind));
  const auto& metal = std::get<RoughConductorBsdf>(nested[static_cast<size_t>(twosided.back)].kind);
  EXPECT_EQ(metal.roughness.alpha_v.value, 0.3);
  EXPECT_EQ(metal.eta.value, dvec3(.14304, .37531, 1.44205));
}

TEST_F(LoadScene, Media) {
  const Scene scene = load_body(
      "<medium type=\"homogeneous\" id=\"fog\"><float name=\"sigma_t\" value=\"3\"/><float name=\"scale\" "
      "value=\"2\"/>"
      "<phase type=\"blendphase\"><float name=\"weight\" value=\"0.25\"/><phase type=\"isotropic\"/>"
      "<phase type=\"hg\"><float name=\"g\" value=\"-0.5\"/></phase></phase></medium>"
      "<shape type=\"sphere\"><bsdf type=\"null\"/><ref id=\"fog\" name=\"interior\"/></shape>"
      "<shape type=\"cube\"><ref id=\"fog\" name=\"exterior\"/></shape>");
  ASSERT_EQ(scene.media.size(), 1);
  EXPECT_EQ(only<HomogeneousMedium>(scene.media).sigma_t, dvec3(6));
  EXPECT_EQ(only<HomogeneousMedium>(scene.media).albedo, dvec3(0.75));
  const auto& blend = std::get<BlendPhase>(scene.media[0].phase.kind);
  EXPECT_EQ(std::get<HenyeyGreensteinPhase>(blend.second->kind).g, -0.5);
  EXPECT_EQ(scene.shapes[0].interior, 0);
  EXPECT_EQ(scene.shapes[0].exterior, kNone);
  EXPECT_EQ(scene.shapes[1].exterior, 0);
  EXPECT_TRUE(scene.shapes[1].is_medium_boundary);
  EXPECT_TRUE(
      std::holds_alternative<DiffuseBsdf>(scene.bsdfs[static_cast<size_t>(scene.shapes[1].bsdf)].kind));
}

TEST_F(LoadScene, SpellingsOfVersion06) {
  const Scene scene = load(
      "<scene version=\"0.6.0\"><integrator type=\"path\"><integer name=\"maxDepth\" value=\"9\"/>"
      "<integer name=\"rrDepth\" value=\"6\"/><boolean name=\"strictNormals\" value=\"false\"/></integrator>"
      "<sensor type=\"thinlens\"><float name=\"apertureRadius\" value=\"0.2\"/><float name=\"focusDistance\" "
      "value=\"4\"/>"
      "<string name=\"fovAxis\" value=\"x\"/><float name=\"fov\" value=\"30\"/><transform name=\"toWorld\">"
      "<lookAt origin=\"0,0,5\" target=\"0,0,0\" up=\"0,1,0\"/></transform>"
      "<sampler type=\"sobol\"><integer name=\"sampleCount\" value=\"32\"/></sampler>"
      "<film type=\"ldrfilm\"><float name=\"gamma\" value=\"2.2\"/><integer name=\"cropOffsetX\" "
      "value=\"3\"/></film></sensor>"
      "<emitter type=\"spot\"><float name=\"cutoffAngle\" value=\"10\"/></emitter>"
      "<shape type=\"sphere\"><bsdf type=\"roughplastic\"><float name=\"intIOR\" value=\"1.5\"/>"
      "<float name=\"extIOR\" value=\"1\"/><rgb name=\"diffuseReflectance\" value=\"0.1\"/></bsdf></shape>"
      "<shape type=\"cube\"><bsdf type=\"roughconductor\"><float name=\"alphaU\" value=\"0.2\"/>"
      "<float name=\"alphaV\" value=\"0.3\"/><float name=\"extEta\" value=\"2\"/><rgb name=\"eta\" "
      "value=\"1,2,3\"/>"
      "<rgb name=\"k\" value=\"2,4,6\"/></bsdf></shape>"
      "<shape type=\"rectangle\"><medium type=\"homogeneous\" name=\"interior\"><rgb name=\"sigmaS\" "
      "value=\"1,2,3\"/>"
      "<rgb name=\"sigmaA\" value=\"1,0,0\"/></medium></shape>"
      "<shape type=\"disk\"><bsdf type=\"conductor\"/></shape></scene>");
  EXPECT_EQ(scene.integrator.max_depth, 9);
  EXPECT_EQ(scene.integrator.rr_depth, 6);
  EXPECT_EQ(scene.sensors[0].kind, Sensor::Kind::kThinLens);
  EXPECT_EQ(scene.sensors[0].aperture_radius, 0.2);
  EXPECT_EQ(scene.sensors[0].sample_count, 32);
  EXPECT_EQ(scene.sensors[0].film.crop_x, 3);
  EXPECT_NEAR(only<SpotEmitter>(scene.emitters).cutoff_angle, glm::radians(10.0), 1e-15);
  EXPECT_EQ(only<RoughPlasticBsdf>(scene.bsdfs).eta, 1.5);
  EXPECT_EQ(only<RoughPlasticBsdf>(scene.bsdfs).diffuse_reflectance.value, dvec3(0.1));
  EXPECT_EQ(only<RoughConductorBsdf>(scene.bsdfs).eta.value, dvec3(0.5, 1, 1.5));
  EXPECT_EQ(only<HomogeneousMedium>(scene.media).sigma_t, dvec3(2, 2, 3));
  EXPECT_EQ(only<HomogeneousMedium>(scene.media).albedo, dvec3(0.5, 1, 1));
  // A border of a medium that names no bsdf is no surface; a conductor is of copper.
  EXPECT_TRUE(std::holds_alternative<NullBsdf>(scene.bsdfs[static_cast<size_t>(scene.shapes[2].bsdf)].kind));
  expect_near(only<ConductorBsdf>(scene.bsdfs).k.value, dvec3(3.91326, 2.45305, 2.14209) / 1.000277, 1e-12);
}

TEST_F(LoadScene, InstancesAreCopiesOfTheGroup) {
  write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene scene = load_body(
      "<shape type=\"shapegroup\" id=\"g\"><shape type=\"obj\"><string name=\"filename\" value=\"mesh.obj\"/>"
      "<transform name=\"to_world\"><translate x=\"1\"/></transform></shape><shape "
      "type=\"Rectangle\"/></shape>"
      "<shape type=\"instance\"><ref id=\"g\"/></shape><shape type=\"instance\"><ref id=\"g\"/>"
      "<transform name=\"to_world\"><scale x=\"3\"/></transform></shape>");
  ASSERT_EQ(scene.shapes.size(), 4);
  EXPECT_EQ(scene.shapes[0].to_world[3][0], 1);
  EXPECT_EQ(scene.shapes[2].to_world[3][0], 3);  // first the shape's own transform, then the instance's
  EXPECT_EQ(std::get<MeshShape>(scene.shapes[0].kind).mesh, std::get<MeshShape>(scene.shapes[2].kind).mesh);
  EXPECT_EQ(scene.shapes[1].plugin, "rectangle");
}

TEST_F(LoadScene, NormalAndHeightMaps) {
  const Scene flat = load_body(
      "<shape type=\"sphere\"><bsdf type=\"normalmap\"><spectrum type=\"srgb\" name=\"normalmap\">"
      "<rgb name=\"color\" value=\"0.5, 0.5, 1\"/></spectrum><bsdf type=\"diffuse\"/></bsdf></shape>");
  EXPECT_EQ(only<CheckerboardTexture>(flat.textures).color0.value, dvec3(0.5, 0.5, 1));
  EXPECT_EQ(only<NormalMapBsdf>(flat.bsdfs).normalmap, 0);
  const Scene scaled = load_body(
      "<shape type=\"sphere\"><bsdf type=\"bumpmap\"><float name=\"scale\" value=\"3\"/><bsdf "
      "type=\"diffuse\"/>"
      "<texture type=\"scale\"><float name=\"scale\" value=\"5\"/><texture "
      "type=\"checkerboard\"/></texture></bsdf></shape>",
      "0.6.0");
  EXPECT_EQ(only<BumpMapBsdf>(scaled.bsdfs).scale, 15);
  EXPECT_EQ(scaled.textures.size(), 1);
}

TEST_F(LoadScene, CheckerboardsOfTextures) {
  const auto board = [](const std::string& name, const std::string& inside) {
    return "<texture type=\"checkerboard\" " + name + ">" + inside + "</texture>";
  };
  const auto sphere = [](const std::string& reflectance) {
    return "<shape type=\"sphere\"><bsdf type=\"diffuse\">\n" + reflectance + "</bsdf></shape>";
  };
  const std::string stretched = "<transform name=\"to_uv\"><scale value=\"3\"/></transform>";
  const Scene scene = load_body(board("id=\"inner\"", stretched) +
                                sphere(board("name=\"reflectance\"", "<rgb name=\"color0\" value=\"0.1, 0.2, 0.3\"/>"
                                                                     "<ref id=\"inner\" name=\"color1\"/>")));
  ASSERT_EQ(scene.textures.size(), 2);
  const auto& outer = std::get<CheckerboardTexture>(scene.textures[0].kind);
  EXPECT_EQ(outer.color0.texture, kNone);
  EXPECT_EQ(outer.color0.value, dvec3(0.1, 0.2, 0.3));
  EXPECT_EQ(outer.color1.texture, 1);
  EXPECT_EQ(std::get<CheckerboardTexture>(scene.textures[1].kind).color0.value, dvec3(0.4));
  EXPECT_EQ(scene.textures[0].to_uv, dmat3(1));
  EXPECT_EQ(scene.textures[1].to_uv[0][0], 3);

  const auto complain = [&](const std::string& body) {
    return complaint("<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"constant\"/>\n" + body + "</scene>");
  };
  std::string nest = board("name=\"color1\"", "");
  for (int i = 0; i < kMostCheckerboards - 2; ++i) nest = board("name=\"color1\"", nest);
  EXPECT_EQ(complain(sphere(board("name=\"reflectance\"", nest))), "");
  EXPECT_EQ(complain(sphere(board("name=\"reflectance\"", board("name=\"color0\"", nest)))),
            "scene.xml:3: checkerboards inside one another: expected at most 4");
  // A tree of references that doubles at each step.
  std::string tree = board("id=\"t0\"", "");
  for (int i = 1; i < 60; ++i)
    tree += board(fmt::format("id=\"t{}\"", i), fmt::format("<ref id=\"t{0}\" name=\"color0\"/>"
                                                            "<ref id=\"t{0}\" name=\"color1\"/>", i - 1));
  EXPECT_NE(complain(tree + sphere("<ref id=\"t59\" name=\"reflectance\"/>")).find("expected at most 4"),
            std::string::npos);
  EXPECT_NE(complain(board("id=\"a\"", "<ref id=\"a\" name=\"color0\"/>")).find("contains itself"), std::string::npos);
  // The attribute is asked for on each shape that has the material.
  const std::string attribute = board("id=\"a\"", "<texture type=\"mesh_attribute\" name=\"color0\">"
                                                  "<string name=\"name\" value=\"vertex_heat\"/></texture>");
  EXPECT_EQ(complain(attribute), "");
  EXPECT_NE(complain(attribute + sphere("<ref id=\"a\" name=\"reflectance\"/>")).find("no attribute vertex_heat"),
            std::string::npos);
}

TEST_F(LoadScene, PermissiveGoesOnWithoutTheUnknown) {
  const std::string xml =
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"sunsky\"/><emitter "
      "type=\"constant\"/>"
      "<mode type=\"final\"/><shape type=\"hair\"/>"
      "<shape type=\"sphere\"><boolean name=\"shiny\" value=\"true\"/><bsdf type=\"ward\"/></shape></scene>";
  EXPECT_THROW(load(xml), InputError);
  LoadOptions options;
  options.permissive = true;
  const Scene scene = load(xml, options);
  EXPECT_EQ(scene.emitters.size(), 1);
  ASSERT_EQ(scene.shapes.size(), 1);
  EXPECT_TRUE(std::holds_alternative<DiffuseBsdf>(scene.bsdfs[0].kind));
}

TEST_F(LoadScene, PermissiveTakesOpaqueMaterialsOfOldFilesAsTwoSided) {
  const auto scene_of = [&](const std::string& version, bool permissive, const std::string& bsdf) {
    LoadOptions options;
    options.permissive = permissive;
    Scene scene = load("<scene version=\"" + version +
                           "\"><sensor type=\"perspective\"/><emitter type=\"constant\"/><shape type=\"sphere\">" +
                           bsdf + "</shape></scene>",
                       options);
    return scene;
  };
  const auto kind_of = [](const Scene& scene) { return scene.bsdfs[static_cast<size_t>(scene.shapes[0].bsdf)].kind; };
  const std::string diffuse = "<bsdf type=\"diffuse\"/>", masked = "<bsdf type=\"mask\">" + diffuse + "</bsdf>";
  EXPECT_TRUE(std::holds_alternative<DiffuseBsdf>(kind_of(scene_of("0.5.0", false, diffuse))));
  EXPECT_TRUE(std::holds_alternative<DiffuseBsdf>(kind_of(scene_of("3.0.0", true, diffuse))));
  EXPECT_TRUE(std::holds_alternative<TwoSidedBsdf>(kind_of(scene_of("0.5.0", true, diffuse))));
  EXPECT_TRUE(std::holds_alternative<TwoSidedBsdf>(kind_of(scene_of("0.5.0", true, ""))));
  EXPECT_TRUE(std::holds_alternative<DielectricBsdf>(
      kind_of(scene_of("0.5.0", true, "<bsdf type=\"dielectric\"/>"))));
  const Scene cut = scene_of("0.5.0", true, masked);
  const auto child = std::get<MaskBsdf>(kind_of(cut)).child;
  EXPECT_TRUE(std::holds_alternative<TwoSidedBsdf>(cut.bsdfs[static_cast<size_t>(child)].kind));
}

TEST_F(LoadScene, LinesOfElements) {
  const Scene scene = load(
      "<?xml version=\"1.0\"?>\n<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/>\n\n"
      "<!-- two\nlines --><emitter type=\"constant\"/>\n</scene>");
  EXPECT_EQ(scene.sensors[0].where.line, 3);
  EXPECT_EQ(scene.emitters[0].where.line, 6);
}

}  // namespace
}  // namespace tachylite
