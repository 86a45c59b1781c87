#include <cstring>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfTiledOutputFile.h>

#include "image/exr.h"
#include "image/ldr.h"
#include "load_support.h"

namespace tachylite {
namespace {

class ImageTest : public LoadTest {};

Image gradient(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  for (const char* name : {"R", "G", "B"}) {
    auto& channel = image.add(name);
    for (size_t i = 0; i < channel.size(); ++i)
      channel[i] = 0.001f * static_cast<float>(i) * (name[0] == 'G' ? -1 : 1);
  }
  return image;
}

TEST_F(ImageTest, ExrKeepsEveryBit) {
  Image image = gradient(7, 5);
  image.add("variance.R")[3] = 1e-30f;
  image.metadata = {{"spp", "64"}, {"scene", "a b"}};
  write_exr(folder_ / "a.exr", image);
  const Image back = read_exr(folder_ / "a.exr");
  EXPECT_EQ(back.width, 7);
  EXPECT_EQ(back.height, 5);
  EXPECT_FALSE(back.half);
  for (size_t i = 0; i < image.names.size(); ++i) {
    ASSERT_TRUE(back.find(image.names[i]));
    EXPECT_EQ(*back.find(image.names[i]), image.channels[i]);
  }
  EXPECT_EQ(back.metadata.at("spp"), "64");
  EXPECT_EQ(back.metadata.at("scene"), "a b");
}

TEST_F(ImageTest, ExrOfHalfTilesAndAnOffsetWindow) {
  const Imath::Box2i window({-3, 10}, {33, 41});
  Imf::Header header(window, window);
  header.channels().insert("Y", Imf::Channel(Imf::HALF));
  header.setTileDescription(Imf::TileDescription(16, 8));
  const int width = 37, height = 32;
  std::vector<half> values(static_cast<size_t>(width * height));
  for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 512);
  Imf::FrameBuffer frame;
  frame.insert("Y", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values.data() + 3 - 10 * width),
                               sizeof(half), sizeof(half) * width));
  {
    Imf::TiledOutputFile file((folder_ / "tiled.exr").c_str(), header);
    file.setFrameBuffer(frame);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  }
  const Image image = read_exr(folder_ / "tiled.exr");
  EXPECT_TRUE(image.half);
  ASSERT_EQ(image.width, width);
  ASSERT_EQ(image.height, height);
  for (size_t i = 0; i < values.size(); ++i) ASSERT_EQ(image.channels[0][i], static_cast<float>(values[i]));
}

TEST_F(ImageTest, ExrThatCannotBeWrittenLeavesNothing) {
  EXPECT_THROW(write_exr(folder_ / "none" / "a.exr", gradient(2, 2)), RenderError);
  write("taken.exr/file", "");  // a folder of that name
  EXPECT_THROW(write_exr(folder_ / "taken.exr", gradient(2, 2)), RenderError);
  size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) ++entries;
  EXPECT_EQ(entries, 1);
}

TEST_F(ImageTest, SizesAreCheckedBeforeMemoryIsTaken) {
  write_exr(folder_ / "a.exr", gradient(64, 64));
  write_png(folder_ / "a.png", gradient(64, 64));
  EXPECT_THROW(read_exr(folder_ / "a.exr", 64 * 64 - 1), InputError);
  EXPECT_THROW(read_ldr(folder_ / "a.png", 64 * 64 - 1), InputError);
  EXPECT_NO_THROW(read_ldr(folder_ / "a.png", 64 * 64));
}

TEST_F(ImageTest, PngIsSrgb) {
  Image image;
  image.width = 4;
  image.height = 1;
  image.add("R") = {0, 0.2158605f, 1, 7};
  image.add("G") = {-1, 0.002f, 0.5f, std::numeric_limits<float>::quiet_NaN()};
  image.add("B") = {0, 0, 0, 1};
  write_png(folder_ / "a.png", image);
  const DecodedImage back = read_ldr(folder_ / "a.png");
  EXPECT_EQ(back.channels, 3);
  EXPECT_EQ(back.bytes, (std::vector<uint8_t>{0, 0, 0, 128, 7, 0, 255, 188, 0, 255, 0, 255}));
  for (int code = 0; code < 256; ++code)
    EXPECT_EQ(std::lround(255 * linear_to_srgb(srgb_to_linear(static_cast<float>(code) / 255))), code);
}

class LoadTexture : public ImageTest {
 protected:
  Scene load_texture(const std::string& parameters, const std::string& version = "3.0.0") const {
    return load_body(
        "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\">" +
            parameters + "</texture></bsdf></shape>",
        version);
  }
};

TEST_F(LoadTexture, FormatsAndOptions) {
  write_png(folder_ / "a.png", gradient(8, 4));
  write_exr(folder_ / "a.exr", gradient(8, 4));
  const std::string png = "<string name=\"filename\" value=\"a.png\"/>";
  const Scene plain = load_texture(png);
  const auto& texture = only<BitmapTexture>(plain.textures);
  EXPECT_EQ(texture.format, TexelFormat::kUnorm8Srgb);
  EXPECT_EQ(texture.wrap, WrapMode::kRepeat);
  EXPECT_EQ(texture.filter, FilterType::kBilinear);
  EXPECT_EQ(texture.bitmap->width, 8);
  EXPECT_EQ(texture.bitmap->bytes.size(), 8 * 4 * 3);
  const Scene optional =
      load_texture(png +
                   "<boolean name=\"raw\" value=\"true\"/><string name=\"wrap_mode\" value=\"mirror\"/>"
                   "<string name=\"filter_type\" value=\"nearest\"/>");
  EXPECT_EQ(only<BitmapTexture>(optional.textures).format, TexelFormat::kUnorm8Linear);
  EXPECT_EQ(only<BitmapTexture>(optional.textures).wrap, WrapMode::kMirror);
  EXPECT_EQ(only<BitmapTexture>(optional.textures).filter, FilterType::kNearest);
  const Scene exr = load_texture("<string name=\"filename\" value=\"a.exr\"/>");
  EXPECT_EQ(only<BitmapTexture>(exr.textures).format, TexelFormat::kFloat);
  EXPECT_EQ(only<BitmapTexture>(exr.textures).bitmap->floats[3], 0.001f);  // R of the second texel
}

TEST_F(LoadTexture, FilesAreDecodedOnce) {
  write_png(folder_ / "a.png", gradient(8, 4));
  std::filesystem::create_symlink("a.png", folder_ / "b.png");
  const auto shape = [](const char* name) {
    return fmt::format(
        "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\">"
        "<string name=\"filename\" value=\"{}\"/></texture></bsdf></shape>",
        name);
  };
  const Scene scene = load_body(shape("a.png") + shape("b.png"));
  ASSERT_EQ(scene.textures.size(), 2);
  EXPECT_EQ(std::get<BitmapTexture>(scene.textures[0].kind).bitmap,
            std::get<BitmapTexture>(scene.textures[1].kind).bitmap);
}

TEST_F(LoadTexture, TransformOfUv) {
  write_png(folder_ / "a.png", gradient(2, 2));
  const std::string file = "<string name=\"filename\" value=\"a.png\"/>";
  const Scene scene = load_texture(
      file + "<transform name=\"to_uv\"><scale x=\"2\" y=\"3\"/><translate x=\"0.5\" y=\"-1\"/></transform>");
  EXPECT_EQ(scene.textures[0].to_uv * dvec3(1, 1, 1), dvec3(2.5, 2, 1));
  const Scene legacy = load_texture(
      file +
          "<float name=\"uscale\" value=\"2\"/><float name=\"voffset\" value=\"0.5\"/>"
          "<float name=\"gamma\" value=\"1.0\"/><string name=\"filterType\" value=\"trilinear\"/>",
      "0.6.0");
  EXPECT_EQ(legacy.textures[0].to_uv * dvec3(1, 1, 1), dvec3(2, 1.5, 1));
  EXPECT_EQ(only<BitmapTexture>(legacy.textures).format, TexelFormat::kUnorm8Linear);
}

TEST_F(LoadTexture, EnvironmentAndProjector) {
  Image sky = gradient(4, 2);  // its green is negative, and counts as 0
  write_exr(folder_ / "sky.exr", sky);
  write_png(folder_ / "slide.png", gradient(30, 10));
  const Scene scene = load(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"envmap\">"
      "<string name=\"filename\" value=\"sky.exr\"/><float name=\"scale\" value=\"3\"/></emitter>"
      "<emitter type=\"projector\"><float name=\"fov\" value=\"40\"/><string name=\"fov_axis\" value=\"y\"/>"
      "<texture type=\"bitmap\" name=\"irradiance\"><string name=\"filename\" "
      "value=\"slide.png\"/></texture></emitter></scene>");
  const auto& environment = only<EnvironmentEmitter>(scene.emitters);
  EXPECT_EQ(environment.scale, 3);
  EXPECT_FALSE(environment.srgb);
  EXPECT_EQ(environment.bitmap->floats[4], 0);
  EXPECT_EQ(environment.bitmap->floats[3], 0.001f);
  EXPECT_NEAR(only<ProjectorEmitter>(scene.emitters).x_fov, 2 * std::atan(3 * std::tan(glm::radians(20.0))),
              1e-14);
}

TEST_F(LoadTexture, VolumeFiles) {
  std::string vol("VOL\3", 4);
  const auto put = [&](auto value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    vol.append(bytes, sizeof value);
  };
  for (const int32_t n : {1, 3, 1, 2, 1}) put(n);
  for (const float b : {-1.f, -1.f, -1.f, 1.f, 1.f, 1.f}) put(b);
  for (int i = 0; i < 6; ++i) put(0.5f * static_cast<float>(i));
  write("a.vol", vol);
  const Scene scene = load_body(
      "<shape type=\"cube\"><medium type=\"heterogeneous\" name=\"interior\"><volume type=\"gridvolume\" "
      "name=\"sigma_t\">"
      "<string name=\"filename\" value=\"a.vol\"/><transform name=\"to_world\"><translate "
      "x=\"2\"/></transform></volume>"
      "<volume type=\"constvolume\" name=\"albedo\"><rgb name=\"value\" value=\"0.1, 0.2, "
      "0.3\"/></volume></medium></shape>");
  const auto& medium = only<HeterogeneousMedium>(scene.media);
  EXPECT_EQ(medium.sigma_t.grid->nx, 3);
  EXPECT_EQ(medium.sigma_t.grid->nz, 2);
  EXPECT_EQ(medium.sigma_t.grid->values[5], 2.5f);
  EXPECT_EQ(medium.sigma_t.to_world[3][0], 2);
  EXPECT_EQ(medium.albedo.constant, dvec3(0.1, 0.2, 0.3));
}

}  // namespace
}  // namespace tachylite
