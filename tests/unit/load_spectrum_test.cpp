#include <gtest/gtest.h>

#include "load_support.h"
#include "scene/cie_1931.h"
#include "scene/index_of_refraction.h"
#include "scene/parse_spectrum.h"

namespace tachylite {
namespace {

TEST(LoadSpectrum, CurvesHaveTheirIntegral) {
  double y = 0;
  for (const double value : kCieY) y += kCieStep * value;
  EXPECT_NEAR(0.999 * (y - kCieStep * (kCieY.front() + kCieY.back()) / 2), kCieYIntegral, 1e-3);
  double d65 = 0;
  for (size_t i = 0; i < kCieCount; ++i) d65 += kCieStep * kCieY[i] * kD65[i];
  EXPECT_NEAR(d65 / kCieYIntegral, kD65Normalization, 1e-3 * kD65Normalization);
}

TEST(LoadSpectrum, ConstantReflectanceIsWhite) {
  // D65 is normalised by the true integral, the curves by the rule's: 1e-3 is lost.
  expect_near(spectrum_to_rgb({300, 900}, {1, 1}, ColorUse::kReflectance), dvec3(0.9989), 2e-4);
}

TEST(LoadSpectrum, ConstantEmissionIsReddish) {
  expect_near(spectrum_to_rgb({300, 900}, {1, 1}, ColorUse::kEmission), dvec3(1.2048, 0.9483, 0.9088), 5e-4);
}

TEST(LoadSpectrum, CopperOfTheTable) {
  // eta of copper (luxpop.com); Mitsuba's result for it is in the table of named conductors.
  const std::vector<double> wavelengths = {
      302.400421, 306.133759, 309.960449, 313.884003, 317.908142, 322.036835, 326.274139, 330.624481,
      335.092377, 339.682678, 344.400482, 349.251221, 354.240509, 359.374420, 364.659332, 370.102020,
      375.709625, 381.489777, 387.450562, 393.600555, 399.948975, 406.505493, 413.280579, 420.285339,
      427.531647, 435.032196, 442.800629, 450.851562, 459.200653, 467.864838, 476.862213, 486.212463,
      495.936707, 506.057861, 516.600769, 527.592224, 539.061646, 551.040771, 563.564453, 576.670593,
      590.400818, 604.800842, 619.920898, 635.816284, 652.548279, 670.184753, 688.800964, 708.481018,
      729.318665, 751.419250, 774.901123, 799.897949, 826.561157, 855.063293, 885.601257};
  const std::vector<double> eta = {
      1.380000, 1.358438, 1.340000, 1.329063, 1.325000, 1.332500, 1.340000, 1.334375, 1.325000, 1.317812,
      1.310000, 1.300313, 1.290000, 1.281563, 1.270000, 1.249062, 1.225000, 1.200000, 1.180000, 1.174375,
      1.175000, 1.177500, 1.180000, 1.178125, 1.175000, 1.172812, 1.170000, 1.165312, 1.160000, 1.155312,
      1.150000, 1.142812, 1.135000, 1.131562, 1.120000, 1.092437, 1.040000, 0.950375, 0.826000, 0.645875,
      0.468000, 0.351250, 0.272000, 0.230813, 0.214000, 0.209250, 0.213000, 0.216250, 0.223000, 0.236500,
      0.250000, 0.254188, 0.260000, 0.280000, 0.300000};
  expect_near(spectrum_to_rgb(wavelengths, eta, ColorUse::kEmission), find_conductor("Cu")->eta, 1e-5);
}

// Tungsten and nickel after Palik 1985, "Handbook of Optical Constants of Solids", as luxpop.com lists them, at the
// wavelengths that matter: what the named conductors are made of.
TEST(LoadSpectrum, TungstenAndNickelOfTheTable) {
  const std::vector<double> fine = {
      359.362030, 364.647003, 370.089996, 375.696991, 381.477020, 387.437988, 393.587006, 399.935028, 406.492004,
      413.266998, 420.270996, 427.516998, 435.018036, 442.785980, 450.835999, 459.185028, 467.849030, 476.846008,
      486.196014, 495.920013, 506.041016, 516.583008, 527.575012, 539.044006, 551.022034, 563.545044, 576.651001,
      590.381042, 604.781006, 619.900024, 635.795044, 652.526001, 670.162048, 688.778015, 708.456970, 729.294006,
      751.393982, 774.875000, 799.871033, 826.533020, 855.033997};
  expect_near(spectrum_to_rgb(fine, {3.32, 3.39, 3.43, 3.45, 3.45, 3.43, 3.41, 3.39, 3.37, 3.35, 3.33, 3.32, 3.31, 3.30,
                                     3.31, 3.31, 3.32, 3.34, 3.35, 3.38, 3.42, 3.45, 3.48, 3.50, 3.50, 3.49, 3.51, 3.54,
                                     3.57, 3.60, 3.65, 3.70, 3.76, 3.82, 3.85, 3.84, 3.78, 3.67, 3.56, 3.48, 3.38},
                              ColorUse::kEmission),
              find_conductor("W")->eta, 1e-5);
  expect_near(spectrum_to_rgb(fine, {2.70, 2.66, 2.60, 2.55, 2.49, 2.45, 2.43, 2.41, 2.42, 2.42, 2.43, 2.45, 2.47, 2.49,
                                     2.53, 2.55, 2.59, 2.62, 2.64, 2.68, 2.71, 2.72, 2.72, 2.72, 2.73, 2.75, 2.81, 2.84,
                                     2.86, 2.89, 2.92, 2.94, 2.95, 2.91, 2.86, 2.78, 2.72, 2.68, 2.73, 2.79, 2.85},
                              ColorUse::kEmission),
              find_conductor("W")->k, 1e-5);
  const std::vector<double> coarse = {
      354.229004, 364.647003, 375.696991, 387.437988, 399.935028, 413.266998, 427.516998, 442.785980, 459.185028,
      476.846008, 495.920013, 516.583008, 539.044006, 563.545044, 590.381042, 619.900024, 635.795044, 652.526001,
      670.162048, 688.778015, 708.456970, 729.294006, 751.393982, 774.875000, 799.871033, 826.533020, 855.033997};
  expect_near(spectrum_to_rgb(coarse, {1.63, 1.62, 1.61, 1.61, 1.61, 1.61, 1.62, 1.62, 1.64, 1.66, 1.67, 1.71, 1.75, 1.80,
                                       1.85, 1.93, 1.98, 2.02, 2.08, 2.14, 2.21, 2.28, 2.36, 2.43, 2.48, 2.53, 2.59},
                              ColorUse::kEmission),
              find_conductor("Ni_palik")->eta, 1e-5);
  expect_near(spectrum_to_rgb(coarse, {2.11, 2.17, 2.23, 2.30, 2.36, 2.44, 2.52, 2.61, 2.71, 2.81, 2.93, 3.06, 3.19, 3.33,
                                       3.48, 3.65, 3.74, 3.82, 3.91, 4.00, 4.09, 4.18, 4.25, 4.31, 4.38, 4.47, 4.55},
                              ColorUse::kEmission),
              find_conductor("Ni_palik")->k, 1e-5);
}

// Two of those whose spectra the table's own comment names (luxpop.com), and what names mean.
TEST(LoadSpectrum, OtherConductors) {
  const dvec3 iridium = spectrum_to_rgb(
      {354.229004, 364.647003, 375.696991, 387.437988, 399.935028, 413.266998, 427.516998, 442.785980, 459.185028,
       476.846008, 495.920013, 516.583008, 539.044006, 563.545044, 590.381042, 619.900024, 652.526001, 688.778015,
       729.294006, 774.875000, 826.533020, 885.570984},
      {1.50, 1.53, 1.57, 1.62, 1.68, 1.73, 1.77, 1.81, 1.85, 1.91, 1.98, 2.07, 2.18, 2.29, 2.40, 2.50, 2.57, 2.64, 2.69,
       2.68, 2.65, 2.72},
      ColorUse::kEmission);
  expect_near(iridium, find_conductor("Ir")->eta, 1e-5);
  const dvec3 titanium_nitride =
      spectrum_to_rgb({354.229004, 413.266998, 495.920013, 619.900024, 826.533020}, {1.06, 1.04, 1.65, 2.69, 3.81},
                      ColorUse::kEmission);
  // The data end at 826.5 nm, where the curves hardly see.
  expect_near(titanium_nitride, find_conductor("TiN")->k, 1e-5);
  EXPECT_EQ(find_conductor("TiN_palik")->k, find_conductor("TiN")->k);
  EXPECT_NE(find_conductor("Cu_palik")->eta, find_conductor("Cu")->eta);
  EXPECT_EQ(find_conductor("none")->k, dvec3(1));
  for (const char* unknown : {"au", "Ag_palik", "none_palik", "Na", "Ni", "V", "_palik", ""})
    EXPECT_FALSE(find_conductor(unknown)) << unknown;
  for (const char* name : {"a-C", "AlAs_palik", "AlSb", "Be", "CsI", "Cu2O", "CuO", "d-C", "Hg", "HgTe", "K", "Li",
                           "MgO", "Mo", "Na_palik", "Nb", "Ni_palik", "Rh", "Se", "SiC", "SnTe", "Ta", "Te", "ThF4", "TiC",
                           "TiO2", "VC", "V_palik", "VN", "W"})
    EXPECT_TRUE(find_conductor(name)) << name;
}

TEST(LoadSpectrum, OutOfRangeColoursAreClamped) {
  // A narrow line of 500 nm has negative red, and as reflectance of 50 too much green.
  const dvec3 line = spectrum_to_rgb({499, 500, 501}, {0, 50, 0}, ColorUse::kEmission);
  EXPECT_EQ(line.x, 0);
  EXPECT_GT(line.y, 0);
  const dvec3 strong = spectrum_to_rgb({400, 500, 600}, {0, 50, 0}, ColorUse::kReflectance);
  EXPECT_EQ(strong.y, 1);
}

using LoadColor = LoadTest;

dvec3 reflectance_of(const Scene& scene) {
  return only<DiffuseBsdf>(scene.bsdfs).reflectance.value;
}

TEST_F(LoadColor, SpellingsOfReflectance) {
  const auto load_color = [&](const std::string& element, const std::string& version = "3.0.0") {
    return reflectance_of(
        load_body("<shape type=\"sphere\"><bsdf type=\"diffuse\">" + element + "</bsdf></shape>", version));
  };
  const dvec3 color(0.2, 0.5, 0.25);
  expect_near(load_color("<rgb name=\"reflectance\" value=\"0.2, 0.5, 0.25\"/>"), color, 1e-15);
  expect_near(load_color("<rgb name=\"reflectance\" value=\" 0.2 .5,+0.25 \"/>"), color, 1e-15);
  expect_near(load_color("<rgb name=\"reflectance\" value=\"0.3\"/>"), dvec3(0.3), 1e-15);
  expect_near(load_color("<float name=\"reflectance\" value=\"0.3\"/>"), dvec3(0.3), 1e-15);
  expect_near(load_color("<spectrum name=\"reflectance\" value=\"0.3\"/>"), dvec3(0.3), 1e-15);
  expect_near(load_color("<spectrum name=\"reflectance\" value=\"0.2, 0.5, 0.25\"/>", "0.6.0"), color, 1e-15);
  expect_near(load_color("<srgb name=\"reflectance\" value=\"#ff0080\"/>", "0.6.0"), dvec3(1, 0, 0.215861),
              1e-6);
  expect_near(load_color("<rgb name=\"diffuseReflectance\" value=\"0.2, 0.5, 0.25\"/>", "0.6.0"), color,
              1e-15);
}

TEST_F(LoadColor, EmissionTakesConstantSpectraAsSpectra) {
  const auto radiance = [&](const std::string& element, const std::string& version = "3.0.0") {
    const Scene scene =
        load_body("<shape type=\"sphere\"><emitter type=\"area\">" + element + "</emitter></shape>", version);
    return only<AreaEmitter>(scene.emitters).radiance.value;
  };
  expect_near(radiance("<spectrum name=\"radiance\" value=\"2\"/>"), 2.0 * dvec3(1.2048, 0.9483, 0.9088),
              5e-4);
  expect_near(radiance("<spectrum name=\"radiance\" value=\"2\"/>", "0.6.0"), dvec3(2), 0);
  expect_near(radiance("<rgb name=\"radiance\" value=\"2\"/>"), dvec3(2), 0);
  expect_near(radiance("<float name=\"radiance\" value=\"2\"/>"), dvec3(2), 0);
}

TEST_F(LoadColor, SpectrumOfAFile) {
  write("mirror.spd", "# wavelength value\n400 0.5\n\n500 0.5\r\n600 0.5\n700 0.5\n");
  const Scene scene = load_body(
      "<shape type=\"sphere\"><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" "
      "filename=\"mirror.spd\"/></bsdf></shape>"
      "<shape type=\"sphere\"><bsdf type=\"diffuse\">"
      "<spectrum name=\"reflectance\" value=\"400:0.5, 500:0.5, 600:0.5, 700:0.5\"/></bsdf></shape>");
  EXPECT_EQ(std::get<DiffuseBsdf>(scene.bsdfs[0].kind).reflectance.value,
            std::get<DiffuseBsdf>(scene.bsdfs[1].kind).reflectance.value);
}

}  // namespace
}  // namespace tachylite
