// Broken input of every kind: one line with the place, never anything else.

#include "load_support.h"

namespace tachylite {
namespace {

/// `place` is what the message starts with: a file of the test's folder, with a line or without.
struct Case {
  std::string input, place, words;
};

class BadInput : public LoadTest {
 protected:
  void expect_complaint(const Case& expected, const std::string& xml, const LoadOptions& options = {}) const {
    SCOPED_TRACE(expected.input);
    std::string message;
    ASSERT_NO_THROW(message = complaint(xml, options)) << "something else than InputError";
    EXPECT_TRUE(message.starts_with(expected.place + ": ")) << message;
    EXPECT_NE(message.find(expected.words), std::string::npos)
        << message << "\n does not say: " << expected.words;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  /// The input stands on line 3 of a scene that is right otherwise.
  void expect_in_body(const std::vector<Case>& cases) const {
    for (const Case& c : cases)
      expect_complaint(c,
                       "<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/><emitter type=\"constant\"/>"
                       "<shape type=\"sphere\"/>\n" +
                           c.input + "\n</scene>");
  }
};

TEST_F(BadInput, Xml) {
  const std::string good =
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"constant\"/>";
  const std::vector<Case> cases = {
      {"", "scene.xml:1", "broken XML"},
      {"no xml at all", "scene.xml:1", "broken XML"},
      {std::string("\0\1\2\3", 4), "scene.xml:1", "broken XML"},
      {"<scene version=\"3.0.0\">\n<shape type=\"sphere\">\n</scene>", "scene.xml:3", "mismatch"},
      {"<scene version=\"3.0.0\"", "scene.xml:1", "broken XML"},
      {"<bsdf type=\"diffuse\"/>", "scene.xml:1", "expected <scene>"},
      {"<scene>\n</scene>", "scene.xml:1", "version"},
      {"<scene version=\"three\"/>", "scene.xml:1", "version \"three\""},
      {"<scene version=\"4.0.0\"/>", "scene.xml:1", "not supported"},
      {good + "</scene>\n<scene version=\"3.0.0\"/>", "scene.xml:2", "one root"},
      {"<scene version=\"3.0.0\"/>", "scene.xml:1", "no sensor"},
      {"<scene version=\"3.0.0\"><sensor type=\"perspective\"/></scene>", "scene.xml:1", "empty"},
      {"<scene version=\"3.0.0\" unit=\"cm\"/>", "scene.xml:1", "no attribute unit"},
      {"<scene version=\"3.0.0\" version=\"3.0.0\"/>", "scene.xml:1", "twice"},
  };
  for (const Case& c : cases) expect_complaint(c, c.input);
  std::string deep = good;
  for (int i = 0; i < 100000; ++i) deep += "<bsdf type=\"twosided\">";
  for (int i = 0; i < 100000; ++i) deep += "</bsdf>";
  expect_complaint({"deep nesting", "scene.xml:1", "deep"}, deep + "</scene>");
}

TEST_F(BadInput, Structure) {
  write("self.xml", "<scene version=\"3.0.0\">\n<include filename=\"self.xml\"/></scene>");
  write("broken.xml", "<scene version=\"3.0.0\">\n\n<shape></scene>");
  expect_in_body({
      {"stray", "scene.xml:3", "stray text"},
      {"<cube/>", "scene.xml:3", "<cube>"},
      {"<film type=\"hdrfilm\"/>", "scene.xml:3", "<film>"},
      {"<shape/>", "scene.xml:3", "lacks the attribute type"},
      {"<shape type=\"sphere\" color=\"red\"/>", "scene.xml:3", "no attribute color"},
      {"<bsdf type=\"diffuse\" id=\"a\"/>\n<bsdf type=\"diffuse\" id=\"a\"/>", "scene.xml:4", "given twice"},
      {"<alias id=\"x\" as=\"y\"/><alias id=\"z\" as=\"y\"/>", "scene.xml:3", "given twice"},
      {"<shape type=\"cube\">\n<ref id=\"nobody\"/></shape>", "scene.xml:4", "\"nobody\""},
      {"<alias id=\"p\" as=\"q\"/><alias id=\"q\" as=\"p\"/><shape type=\"cube\"><ref id=\"p\"/></shape>",
       "scene.xml:3", "refers to itself"},
      {"<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>", "scene.xml:3", "contains itself"},
      {"<bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf><bsdf type=\"twosided\" id=\"b\"><ref "
       "id=\"a\"/></bsdf>",
       "scene.xml:3", "contains itself"},
      {"<include filename=\"none.xml\"/>", "scene.xml:3", "none.xml"},
      {"<include filename=\"self.xml\"/>", "self.xml:2", "includes itself"},
      {"<include filename=\"broken.xml\"/>", "broken.xml:3", "broken XML"},
      {"<include filename=\".\"/>", ".", "not a regular file"},
      {"<path value=\"nowhere\"/>", "scene.xml:3", "nowhere"},
      {"<shape type=\"sphere\">\n<float name=\"radius\" value=\"$r\"/></shape>", "scene.xml:4",
       "$r has no value"},
      {"<integrator type=\"path\"/><integrator type=\"path\"/>", "scene.xml:3", "several integrators"},
      {"<shape type=\"cube\"><bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/></shape>", "scene.xml:3",
       "several <bsdf>"},
      {"<emitter type=\"constant\"/>", "scene.xml:3", "several environments"},
  });
}

TEST_F(BadInput, Options) {
  const std::string scene =
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"constant\"/></scene>";
  LoadOptions options;
  options.parameters = {{"spp", "3"}};
  expect_complaint({"-D of nothing", "scene.xml", "$spp"}, scene, options);
  options.parameters = {{"n", "many"}};
  expect_complaint(
      {"-D of no number", "scene.xml:2", "many"},
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><sampler type=\"independent\">\n"
      "<integer name=\"sample_count\" value=\"$n\"/></sampler></sensor><emitter type=\"constant\"/></scene>",
      options);
  EXPECT_THROW(load_scene(folder_ / "none.xml"), InputError);
  EXPECT_THROW(load_scene(folder_), InputError);
}

TEST_F(BadInput, Parameters) {
  const auto sphere = [](const std::string& inner) {
    return "<shape type=\"sphere\">\n" + inner + "</shape>";
  };
  const auto bsdf = [](const std::string& type, const std::string& inner) {
    return "<shape type=\"cube\"><bsdf type=\"" + type + "\">\n" + inner + "</bsdf></shape>";
  };
  expect_in_body({
      {sphere("<float name=\"radius\" value=\"1m\"/>"), "scene.xml:4", "1m"},
      {sphere("<float name=\"radius\" value=\"\"/>"), "scene.xml:4", "a number"},
      {sphere("<float name=\"radius\" value=\"nan\"/>"), "scene.xml:4", "a number"},
      {sphere("<float name=\"radius\" value=\"inf\"/>"), "scene.xml:4", "a number"},
      {sphere("<float name=\"radius\" value=\"1e999\"/>"), "scene.xml:4", "a number"},
      {sphere("<float name=\"radius\" value=\"0x10\"/>"), "scene.xml:4", "a number"},
      {sphere("<float name=\"radius\" value=\"0\"/>"), "scene.xml:4", "above 0"},
      {sphere("<float name=\"radius\" value=\"-2\"/>"), "scene.xml:4", "above 0"},
      {sphere("<string name=\"radius\" value=\"1\"/>"), "scene.xml:4", "expected <float>"},
      {sphere("<float name=\"radius\" value=\"1\"><float name=\"a\" value=\"1\"/></float>"), "scene.xml:4",
       "cannot hold"},
      {sphere("<float name=\"radius\" value=\"1\"/>\n<float name=\"radius\" value=\"2\"/>"), "scene.xml:5",
       "twice"},
      {sphere("<float name=\"wobble\" value=\"1\"/>"), "scene.xml:4", "no parameter wobble"},
      {sphere("<point name=\"center\" value=\"1 2\"/>"), "scene.xml:4", "three numbers"},
      {sphere("<point name=\"center\" x=\"a\"/>"), "scene.xml:4", "expected a number"},
      {sphere("<point name=\"center\" x=\"1\" value=\"1\"/>"), "scene.xml:4", "as well as"},
      {sphere("<boolean name=\"flip_normals\" value=\"yes\"/>"), "scene.xml:4", "true or false"},
      {bsdf("diffuse", "<rgb name=\"reflectance\" value=\"0.5, 1.5, 0.5\"/>"), "scene.xml:4", "[0, 1]"},
      {bsdf("diffuse", "<rgb name=\"reflectance\" value=\"-0.1\"/>"), "scene.xml:4", "negative"},
      {bsdf("diffuse", "<rgb name=\"reflectance\" value=\"1, 2\"/>"), "scene.xml:4", "three numbers"},
      {bsdf("diffuse", "<rgb name=\"reflectance\" value=\"red\"/>"), "scene.xml:4", "red"},
      {bsdf("diffuse", "<spectrum name=\"reflectance\" value=\"400:1\"/>"), "scene.xml:4", "two pairs"},
      {bsdf("diffuse", "<spectrum name=\"reflectance\" value=\"500:1, 400:1\"/>"), "scene.xml:4", "rise"},
      {bsdf("diffuse", "<spectrum name=\"reflectance\" value=\"400:a, 500:1\"/>"), "scene.xml:4",
       "wavelength:value"},
      {bsdf("diffuse", "<spectrum name=\"reflectance\" filename=\"a.spd\"/>"), "scene.xml:4", "a.spd"},
      {bsdf("diffuse", "<blackbody name=\"reflectance\" temperature=\"5000\"/>"), "scene.xml:4",
       "<blackbody>"},
      {bsdf("roughconductor", "<float name=\"alpha\" value=\"-0.1\"/>"), "scene.xml:4", "at least 0"},
      {bsdf("roughconductor", "<string name=\"distribution\" value=\"phong\"/>"), "scene.xml:4",
       "beckmann, ggx"},
      {bsdf("roughconductor", "<float name=\"alpha_u\" value=\"0.1\"/>"), "scene.xml:3", "alpha_v"},
      {bsdf("conductor", "<string name=\"material\" value=\"unobtainium\"/>"), "scene.xml:4", "unobtainium"},
      {bsdf("dielectric", "<string name=\"int_ior\" value=\"milk\"/>"), "scene.xml:4", "milk"},
      {bsdf("dielectric", "<float name=\"int_ior\" value=\"0\"/>"), "scene.xml:4", "above 0"},
      {bsdf("principled", "<float name=\"eta\" value=\"1.4\"/><float name=\"specular\" value=\"0.4\"/>"),
       "scene.xml:4", "as well as"},
      {bsdf("principled", "<float name=\"metallic\" value=\"2\"/>"), "scene.xml:4", "[0, 1]"},
      {bsdf("twosided", ""), "scene.xml:3", "0 bsdfs"},
      {bsdf("twosided", "<bsdf type=\"dielectric\"/>"), "scene.xml:3", "light passes"},
      {bsdf("blendbsdf", "<bsdf type=\"diffuse\"/><float name=\"weight\" value=\"0.5\"/>"), "scene.xml:3",
       "expected 2"},
      {bsdf("bumpmap", "<bsdf type=\"diffuse\"/>"), "scene.xml:3", "no texture"},
      {bsdf("blinnphong", "<rgb name=\"diffuse_reflectance\" value=\"0.9\"/>"), "scene.xml:3", "exceed 1"},
      {bsdf("velvet", ""), "scene.xml:3", "velvet is not supported"},
      {"<texture type=\"marble\" id=\"t\"/>", "scene.xml:3", "marble is not supported"},
      {"<emitter type=\"area\"/>", "scene.xml:3", "inside a shape"},
      {sphere("<emitter type=\"point\"/>"), "scene.xml:4", "cannot stand inside"},
      {"<emitter type=\"sunsky\"/>", "scene.xml:3", "sunsky is not supported"},
      {"<emitter type=\"point\">\n<rgb name=\"intensity\" value=\"-1\"/></emitter>", "scene.xml:4",
       "negative"},
      {"<emitter type=\"directional\"><vector name=\"direction\" value=\"0\"/></emitter>", "scene.xml:3",
       "not zero"},
      {"<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"180\"/></emitter>", "scene.xml:3",
       "(0, 180)"},
      {"<shape type=\"hair\"/>", "scene.xml:3", "hair is not supported"},
      {"<shape type=\"shapegroup\"><shape type=\"hair\"/></shape>", "scene.xml:3", "hair is not supported"},
      {"<shape type=\"instance\"/>", "scene.xml:3", "no shapegroup"},
      {"<shape type=\"shapegroup\"><shape type=\"instance\"/></shape>", "scene.xml:3", "inside a shapegroup"},
      {"<shape type=\"shapegroup\">" + sphere("<emitter type=\"area\"/>") + "</shape>", "scene.xml:4",
       "inside a shapegroup"},
      {bsdf("diffuse",
            "<texture type=\"mesh_attribute\" name=\"reflectance\">"
            "<string name=\"name\" value=\"vertex_color\"/></texture>"),
       "scene.xml:3", "no attribute vertex_color"},
      {bsdf("diffuse",
            "<texture type=\"mesh_attribute\" name=\"reflectance\">"
            "<string name=\"name\" value=\"color\"/></texture>"),
       "scene.xml:4", "vertex_..."},
      {bsdf("diffuse", "<spectrum type=\"blackbody\" name=\"reflectance\"/>"), "scene.xml:4",
       "blackbody is not"},
      {"<integrator type=\"bdpt\"/>", "scene.xml:3", "bdpt is not supported"},
      {"<integrator type=\"moment\"/>", "scene.xml:3", "no integrator"},
      {"<integrator type=\"path\"><integer name=\"max_depth\" value=\"-2\"/></integrator>", "scene.xml:3",
       "at least -1"},
      {"<integrator type=\"path\"><integer name=\"max_depth\" value=\"3.5\"/></integrator>", "scene.xml:3",
       "whole number"},
      {"<integrator type=\"path\"><string name=\"sampling\" value=\"light\"/></integrator>", "scene.xml:3",
       "mis, emitter, bsdf"},
      {"<integrator type=\"direct\"><integer name=\"bsdf_samples\" value=\"0\"/>\n"
       "<string name=\"sampling\" value=\"mis\"/></integrator>",
       "scene.xml:4", "sampling as well as bsdf_samples"},
      {"<integrator type=\"aov\"><string name=\"aovs\" value=\"x:taste\"/></integrator>", "scene.xml:3",
       "taste"},
      {"<integrator type=\"aov\"><string name=\"aovs\" value=\"x:duv_dx\"/></integrator>", "scene.xml:3",
       "duv_dx is not supported"},
      {"<integrator type=\"aov\"><string name=\"aovs\" value=\"x:geo_normal, x:sh_normal\"/><integrator "
       "type=\"path\"/></integrator>",
       "scene.xml:3", "two AOVs"},
      {"<emitter type=\"sunsky\"/>", "scene.xml:3", "sunsky is not supported"},
      {"<emitter type=\"sun\"/>", "scene.xml:3", "sun is not supported"},
      {"<emitter type=\"sky\"/>", "scene.xml:3", "sky is not supported"},
      {"<medium type=\"homogeneous\"><rgb name=\"sigma_t\" value=\"3\"/></medium>", "scene.xml:3", "[0, 1]"},
      {"<medium type=\"homogeneous\"><phase type=\"hg\"><float name=\"g\" value=\"1\"/></phase></medium>",
       "scene.xml:3", "(-1, 1)"},
      {sphere(
           "<ref name=\"interior\" id=\"m\"/></shape><bsdf type=\"diffuse\" id=\"m\"/><shape type=\"cube\">"),
       "scene.xml:4", "expected <medium>"},
  });
}

TEST_F(BadInput, TransformsSensorsAndFilms) {
  const auto shape = [](const std::string& type, const std::string& operation) {
    return "<shape type=\"" + type + "\"><transform name=\"to_world\">\n" + operation +
           "</transform></shape>";
  };
  const std::string huge = "<scale value=\"1e38\"/><scale value=\"1e38\"/><scale value=\"1e38\"/>";
  const auto film = [](const std::string& inner) {
    return "<sensor type=\"perspective\"><film type=\"hdrfilm\">\n" + inner + "</film></sensor>";
  };
  const auto sensor = [](const std::string& inner) {
    return "<sensor type=\"thinlens\">\n" + inner + "</sensor>";
  };
  expect_in_body({
      {shape("cube", "<scale z=\"0\"/>"), "scene.xml:3", "singular"},
      {shape("cube", "<matrix value=\"1 2 3\"/>"), "scene.xml:4", "16 or 9"},
      {shape("cube", "<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\"/>"), "scene.xml:3", "affine"},
      {shape("cube", "<rotate angle=\"30\"/>"), "scene.xml:4", "lacks x, y, z"},
      {shape("cube", "<rotate x=\"0\" angle=\"30\"/>"), "scene.xml:4", "no axis"},
      {shape("cube", "<lookat origin=\"1,1,1\" target=\"1,1,1\" up=\"0,1,0\"/>"), "scene.xml:4", "the same"},
      {shape("cube", "<lookat origin=\"0,0,0\" target=\"0,3,0\" up=\"0,1,0\"/>"), "scene.xml:4", "parallel"},
      {shape("cube", "<shear x=\"1\"/>"), "scene.xml:4", "no transform"},
      {shape("cube", huge + huge + huge), "scene.xml:3", "overflows"},
      {shape("sphere", "<scale x=\"2\"/>"), "scene.xml:3", "alike"},
      {shape("cylinder", "<scale x=\"2\"/>"), "scene.xml:3", "circle"},
      {shape("rectangle", "<translate x=\"2e9\"/>"), "scene.xml:3", "too far"},
      {"<shape type=\"sphere\"><float name=\"radius\" value=\"1e20\"/></shape>", "scene.xml:3", "too far"},
      {"<shape type=\"cylinder\"><point name=\"p1\" value=\"0\"/></shape>", "scene.xml:3",
       "different from p0"},
      {film("<integer name=\"width\" value=\"0\"/>"), "scene.xml:4", "[1, 65536]"},
      {film("<integer name=\"width\" value=\"99999999999999999999\"/>"), "scene.xml:4", "whole number"},
      {film("<integer name=\"width\" value=\"65536\"/><integer name=\"height\" value=\"65536\"/>"),
       "scene.xml:4", "pixels"},
      {film("<integer name=\"crop_offset_x\" value=\"768\"/>"), "scene.xml:4", "[0, 767]"},
      {film("<integer name=\"crop_width\" value=\"769\"/>"), "scene.xml:4", "[1, 768]"},
      {film("<rfilter type=\"mitchell\"/>"), "scene.xml:4", "mitchell is not supported"},
      {film("<rfilter type=\"gaussian\"><float name=\"stddev\" value=\"0\"/></rfilter>"), "scene.xml:4",
       "(0, 16]"},
      {"<sensor type=\"fisheye\"/>", "scene.xml:3", "fisheye is not supported"},
      {sensor("<float name=\"fov\" value=\"180\"/><float name=\"aperture_radius\" value=\"1\"/>"),
       "scene.xml:4", "(0, 180)"},
      {sensor("<float name=\"fov\" value=\"30\"/>"), "scene.xml:3", "aperture_radius"},
      {sensor("<string name=\"fov_axis\" value=\"z\"/>"), "scene.xml:4", "diagonal"},
      {sensor("<string name=\"focal_length\" value=\"long\"/>"), "scene.xml:4", "50mm"},
      {sensor("<float name=\"near_clip\" value=\"5\"/><float name=\"far_clip\" value=\"4\"/>"), "scene.xml:4",
       "above 5"},
      {"<sensor type=\"perspective\"><transform name=\"to_world\"><scale value=\"2\"/></transform></sensor>",
       "scene.xml:3", "must not scale"},
      {"<sensor type=\"perspective\"><sampler type=\"independent\">\n<integer name=\"sample_count\" "
       "value=\"0\"/></sampler>"
       "</sensor>",
       "scene.xml:4", "at least 1"},
      {"<sensor type=\"perspective\"><sampler type=\"zigzag\"/></sensor>", "scene.xml:3",
       "zigzag is not supported"},
  });
}

}  // namespace
}  // namespace tachylite
