// Broken meshes, volumes and images.

#include <cstring>

#include "image/exr.h"
#include "image/ldr.h"
#include "load_support.h"

namespace tachylite {
namespace {

std::string little_endian(std::initializer_list<float> values) {
  std::string bytes(values.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}
std::string little_endian(std::initializer_list<int32_t> values) {
  std::string bytes(values.size() * sizeof(int32_t), '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}

class BadFile : public LoadTest {
 protected:
  struct Case {
    std::string content, place, words;
  };
  /// The scene names the file once as `element` says.
  void expect_complaints(const std::string& file, const std::string& element,
                         const std::vector<Case>& cases) const {
    for (size_t i = 0; i < cases.size(); ++i) {
      SCOPED_TRACE(fmt::format("case {} of {}", i, file));
      write(file, cases[i].content);
      std::string message;
      ASSERT_NO_THROW(message = complaint("<scene version=\"3.0.0\"><sensor type=\"perspective\"/>" +
                                          element + "</scene>"));
      EXPECT_TRUE(message.starts_with(cases[i].place + ": ")) << message;
      EXPECT_NE(message.find(cases[i].words), std::string::npos) << message;
    }
  }
  std::string shape(const std::string& type, const std::string& file) const {
    return fmt::format("<shape type=\"{}\"><string name=\"filename\" value=\"{}\"/></shape>", type, file);
  }
  std::string texture(const std::string& file) const {
    return fmt::format(
        "<shape type=\"cube\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\">"
        "<string name=\"filename\" value=\"{}\"/></texture></bsdf></shape>",
        file);
  }
  std::string content(const std::string& file) const {
    std::ifstream stream(folder_ / file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(BadFile, Obj) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_complaints("m.obj", shape("obj", "m.obj"),
                    {
                        {"", "m.obj", "no faces"},
                        {v, "m.obj", "no faces"},
                        {v + "f 1 2 4\n", "m.obj:4", "vertex 4, but 3"},
                        {v + "f 1 2 0\n", "m.obj:4", "vertex 0"},
                        {v + "f 1 2 -4\n", "m.obj:4", "vertex -4"},
                        {v + "f 1 2 99999999999999999999\n", "m.obj:4", "99999999999999999999"},
                        {v + "f 1/1 2/1 3/1\n", "m.obj:4", "texture coordinate 1, but 0"},
                        {v + "f 1//1 2//1 3//1\n", "m.obj:4", "normal 1, but 0"},
                        {v + "f 1 2\n", "m.obj:4", "2 corners"},
                        {v + "f 1 2 x\n", "m.obj:4", "\"x\""},
                        {v + "f 1/ 2 3\n", "m.obj:4", "\"1/\""},
                        {v + "f 1/1/1/1 2 3\n", "m.obj:4", "1, but 0"},
                        {"v 0 0\n", "m.obj:1", "z is"},
                        {"v 0 0 zero\n", "m.obj:1", "zero"},
                        {"# c\n\nv nan 0 0\n", "m.obj:3", "nan"},
                        {"v 0 inf 0\n", "m.obj:1", "finite"},
                        {"v 0 1e60 0\n", "m.obj:1", "finite"},
                        {"vt\n", "m.obj:1", "u is"},
                        {"vn 0 0 1x\n", "m.obj:1", "1x"},
                        {"curv 0 1 1 2\n", "m.obj:1", "curv"},
                        {"\x7f"
                         "ELF\2\1\1",
                         "m.obj:1", "not supported"},
                    });
  const std::string emitting =
      shape("obj", "m.obj").replace(shape("obj", "m.obj").size() - 8, 0, "<emitter type=\"area\"/>");
  expect_complaints("m.obj", emitting, {{v + "f 1 2 2\nf 3 3 3\n", "scene.xml:1", "degenerate"}});
  expect_complaints("m.obj", shape("obj", "m.obj"),
                    {{"v 0 0 3e38\nv 1 0 0\nv 0 1 0\nf 1 2 3", "scene.xml:1", "too far"}});
  expect_complaints("other.obj", shape("obj", "none.obj"), {{"", "scene.xml:1", "none.obj"}});
}

TEST_F(BadFile, PlyHeader) {
  const std::string ply = "ply\nformat ascii 1.0\n";
  expect_complaints("m.ply", shape("ply", "m.ply"),
                    {
                        {"", "m.ply:1", "not a PLY"},
                        {"OFF\n", "m.ply:1", "not a PLY"},
                        {"ply\n", "m.ply:2", "end_header"},
                        {"ply\nend_header\n", "m.ply:2", "no format"},
                        {"ply\nformat ascii 2.0\n", "m.ply:2", "version"},
                        {"ply\nformat morse 1.0\n", "m.ply:2", "morse"},
                        {ply + "property float x\n", "m.ply:3", "before the first element"},
                        {ply + "element vertex many\n", "m.ply:3", "many"},
                        {ply + "element vertex -3\n", "m.ply:3", "-3"},
                        {ply + "element vertex 3\nproperty quad x\n", "m.ply:4", "quad"},
                        {ply + "element vertex 3\nproperty float x\nproperty float x\n", "m.ply:5", "twice"},
                        {ply + "element vertex 3\nproperty list float int x\n", "m.ply:4", "integer"},
                        {ply + "element vertex 3 4\n", "m.ply:3", "more words"},
                        {ply + "colour red\n", "m.ply:3", "colour"},
                        {ply + "element face 0\nproperty list uchar int vertex_indices\nend_header\n",
                         "m.ply:6", "no element vertex"},
                        {ply + "element vertex 0\nproperty float x\nend_header\n", "m.ply:3", "x, y, z"},
                        {ply + "element vertex 4000000000\nproperty float x\nproperty float y\nproperty "
                               "float z\nend_header\n0 0 0\n",
                         "m.ply:3", "cut short"},
                        {ply + "element vertex 9000000000000000000\nproperty float x\nproperty float "
                               "y\nproperty float z\nend_header\n",
                         "m.ply:3", "cut short"},
                    });
}

TEST_F(BadFile, PlyBody) {
  const std::string vertex = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string ascii = "ply\nformat ascii 1.0\n" + vertex + face + "end_header\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string binary = "ply\nformat binary_little_endian 1.0\n" + vertex + face + "end_header\n";
  const std::string points = little_endian({0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect_complaints(
      "m.ply", shape("ply", "m.ply"),
      {
          {ascii, "m.ply:7", "cut short"},
          {ascii + "3 0 1\n", "m.ply:14", "cut short"},
          {ascii + "3 0 1 3\n", "m.ply:13", "vertex 3"},
          {ascii + "3 0 1 -1\n", "m.ply:13", "vertex -1"},
          {ascii + "3 0 1 1.5\n", "m.ply:13", "1.5"},
          {ascii + "2 0 1\n", "m.ply:13", "2 corners"},
          {ascii + "300 0 1\n", "m.ply:13", "does not fit"},
          {"ply\nformat ascii 1.0\n" + vertex + face + "end_header\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n",
           "m.ply:11", "nan"},
          {"ply\nformat ascii 1.0\n" + vertex + "end_header\n0 0 0\n1 0 0\n0 1 0\n", "m.ply", "no faces"},
          {"ply\nformat ascii 1.0\n" + vertex +
               "element face 1\nproperty int a\nend_header\n0 0 0\n1 0 0\n0 1 0\n1\n",
           "m.ply:7", "vertex_indices"},
          {binary + points.substr(0, 20), "m.ply:3", "cut short"},
          {binary + points + "\3", "m.ply", "cut short"},
          {binary + points + "\3" + little_endian({0, 1}), "m.ply", "cut short"},
          {binary + points + "\3" + little_endian({0, 1, 3}), "m.ply", "vertex 3"},
          {binary + points + "\3" + little_endian({0, 1, -1}), "m.ply", "vertex -1"},
          {binary + little_endian({0.f, nan, 0.f}) + points.substr(12) + "\3" + little_endian({0, 1, 2}),
           "m.ply", "vertex 0 holds nan"},
      });
}

TEST_F(BadFile, Volumes) {
  const std::string head = std::string("VOL\3", 4);
  const std::string box = little_endian({0.f, 0.f, 0.f, 1.f, 1.f, 1.f});
  const auto medium = [](const char* parameter) {
    return fmt::format(
        "<shape type=\"cube\"><medium type=\"heterogeneous\" name=\"interior\"><volume type=\"gridvolume\" "
        "name=\"{}\"><string name=\"filename\" value=\"m.vol\"/></volume></medium></shape>",
        parameter);
  };
  expect_complaints(
      "m.vol", medium("sigma_t"),
      {
          {"", "m.vol", "VOL"},
          {"VOL\3", "m.vol", "48 bytes"},
          {std::string("VOL\2", 4) + little_endian({1, 1, 1, 1, 1}) + box, "m.vol", "version 2"},
          {head + little_endian({2, 1, 1, 1, 1}) + box, "m.vol", "type 2"},
          {head + little_endian({1, 1, 1, 1, 5}) + box, "m.vol", "5 channels"},
          {head + little_endian({1, 0, 1, 1, 1}) + box, "m.vol", "0 x 1 x 1"},
          {head + little_endian({1, 2, 2, 2, 1}) + box + little_endian({1.f}), "m.vol", "cut short"},
          {head + little_endian({1, 2147483647, 2147483647, 2147483647, 3}) + box, "m.vol", "cut short"},
          {head + little_endian({1, 1, 1, 1, 1}) + box + little_endian({-1.f}), "m.vol", "-1"},
          {head + little_endian({1, 1, 1, 1, 1}) + box +
               little_endian({std::numeric_limits<float>::infinity()}),
           "m.vol", "inf"},
          {head + little_endian({1, 1, 1, 1, 1}) + little_endian({0.f, 0.f, 0.f, 0.f, 1.f, 1.f}) +
               little_endian({1.f}),
           "m.vol", "bounding box"},
      });
  expect_complaints(
      "m.vol", medium("albedo"),
      {{head + little_endian({1, 1, 1, 1, 1}) + box + little_endian({1.5f}), "m.vol", "[0, 1]"}});
}

Image small_image() {
  Image image;
  image.width = 40;
  image.height = 30;
  for (const char* name : {"R", "G", "B"}) {
    auto& channel = image.add(name);
    for (size_t i = 0; i < channel.size(); ++i)
      channel[i] = static_cast<float>(i * 2654435761u % 1000) / 1000;
  }
  return image;
}

TEST_F(BadFile, Png) {
  write_png(folder_ / "good.png", small_image());
  const std::string good = content("good.png");
  std::string huge = good;
  huge.replace(16, 8, std::string("\0\x40\0\0\0\x40\0\0", 8));  // 4194304 x 4194304
  std::string narrow = good;
  narrow.replace(16, 4, std::string("\0\0\0\0", 4));
  expect_complaints("m.png", texture("m.png"),
                    {
                        {"", "m.png", "not a readable"},
                        {"hello", "m.png", "not a readable"},
                        {good.substr(0, 20), "m.png", ""},
                        {good.substr(0, good.size() / 2), "m.png", ""},
                        {huge, "m.png", ""},
                        {narrow, "m.png", ""},
                    });
}

TEST_F(BadFile, BmpAndTga) {
  // 2 x 2 pixels of 24 bits: rows of 8 bytes.
  const std::string bmp = "BM" + little_endian({70, 0, 54, 40, 2, 2}) + std::string("\1\0\x18\0", 4) +
                          little_endian({0, 16, 0, 0, 0, 0});
  ASSERT_EQ(bmp.size(), 54);
  write("good.bmp", bmp + std::string(16, 'a'));
  EXPECT_EQ(read_ldr(folder_ / "good.bmp").width, 2);
  expect_complaints("m.bmp", texture("m.bmp"),
                    {{bmp + std::string(7, 'a'), "m.bmp", "cut short"}, {bmp.substr(0, 30), "m.bmp", ""}});
  const std::string tga = std::string("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\2\0\x18\0", 18);
  write("good.tga", tga + std::string(12, 'a'));
  EXPECT_EQ(read_ldr(folder_ / "good.tga").height, 2);
  expect_complaints("m.tga", texture("m.tga"), {{tga + std::string(5, 'a'), "m.tga", "cut short"}});
}

TEST_F(BadFile, Jpeg) {
  // Start of image, then start of scan: data that break off.
  expect_complaints(
      "m.jpg", texture("m.jpg"),
      {{"\xff\xd8\xff\xc4" + std::string("\1\4", 2) + std::string(17, '\xff'), "m.jpg", "Huffman"},
       {"\xff\xd8\xff\xe0", "m.jpg", ""},
       {"\xff\xd8\xff\xda\1\2\3\4", "m.jpg", ""}});
}

TEST_F(BadFile, Hdr) {
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n";
  write("good.hdr", head + std::string(16, 'a'));
  EXPECT_EQ(read_ldr(folder_ / "good.hdr").floats.size(), 12);
  expect_complaints(
      "m.hdr", texture("m.hdr"),
      {
          {head + std::string(9, 'a'), "m.hdr", "cut short"},
          // A run-length row of 8 pixels whose data end.
          {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n" + std::string("\2\2\0\x8", 4), "m.hdr", ""},
          {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 200000 +X 200000\n", "m.hdr", ""},
          {"#?RADIANCE\n", "m.hdr", ""},
      });
}

TEST_F(BadFile, Exr) {
  write_exr(folder_ / "good.exr", small_image());
  const std::string good = content("good.exr");
  Image bad_texel = small_image();
  bad_texel.channels[1][41] = std::numeric_limits<float>::infinity();
  write_exr(folder_ / "inf.exr", bad_texel);
  Image odd;
  odd.width = odd.height = 2;
  odd.add("depth.Z");
  odd.add("id");
  write_exr(folder_ / "odd.exr", odd);
  std::string attribute = good;  // of 2 GB
  attribute.replace(attribute.find("chlist") + 7, 4, little_endian({2000000000}));
  std::string huge = good;
  const size_t window = huge.find("dataWindow") + std::string("dataWindow\0box2i\0\20\0\0\0", 21).size();
  huge.replace(window + 8, 8, little_endian({2000000000, 2000000000}));
  expect_complaints("m.exr", texture("m.exr"),
                    {
                        {"", "m.exr", "not a readable EXR"},
                        {"hello", "m.exr", "not a readable EXR"},
                        {good.substr(0, 100), "m.exr", "not a readable EXR"},
                        {good.substr(0, good.size() / 2), "m.exr", "not a readable EXR"},
                        {attribute, "m.exr", "attribute is cut short"},
                        {huge, "m.exr", "not a readable EXR"},
                        {content("inf.exr"), "m.exr", "column 1, row 1"},
                        {content("odd.exr"), "m.exr", "depth.Z id"},
                    });
}

TEST_F(BadFile, EveryByteOfSmallFiles) {
  // Any single byte overwritten: an answer or an InputError, nothing else.
  Image tiny;
  tiny.width = 3;
  tiny.height = 2;
  for (const char* name : {"R", "G", "B"}) tiny.add(name);
  write_exr(folder_ / "t.exr", tiny);
  write_png(folder_ / "t.png", tiny);
  const auto mutate = [&](const std::string& name, const auto& read) {
    const std::string good = content(name);
    for (size_t i = 0; i < good.size(); ++i) {
      std::string bad = good;
      bad[i] = static_cast<char>(i % 2 == 0 ? ~bad[i] : bad[i] + 1);
      const auto file = write("bad" + name, bad);
      try {
        read(file);
      } catch (const InputError&) {
      }
    }
  };
  EXPECT_NO_THROW(mutate("t.exr", [](const auto& file) { read_exr(file, 1 << 16); }));
  EXPECT_NO_THROW(mutate("t.png", [](const auto& file) { read_ldr(file, 1 << 16); }));
}

}  // namespace
}  // namespace tachylite
