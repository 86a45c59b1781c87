// Input that is small but asks for much: cycles and trees of references, includes that multiply, headers that lie; and
// numbers, encodings and kinds of files that no reader of text expects.

#include <sys/stat.h>

#include "image/exr.h"
#include "image/ldr.h"
#include "load_support.h"

namespace tachylite {
namespace {

class BadInputLimits : public LoadTest {
 protected:
  void expect_complaint(const std::string& xml, const std::string& place, const std::string& words) const {
    SCOPED_TRACE(words);
    std::string message;
    ASSERT_NO_THROW(message = complaint(xml));
    EXPECT_TRUE(message.starts_with(place + ": ")) << message.substr(0, 300);
    EXPECT_NE(message.find(words), std::string::npos) << message.substr(0, 300);
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  /// On line 2 of a scene that is right otherwise.
  void expect_in_body(const std::string& body, const std::string& words) const {
    expect_complaint(scene(body), "scene.xml:2", words);
  }
  static std::string scene(const std::string& body, const char* version = "3.0.0") {
    return fmt::format("<scene version=\"{}\"><sensor type=\"perspective\"/><emitter type=\"constant\"/>\n{}</scene>",
                       version, body);
  }
};

TEST_F(BadInputLimits, References) {
  std::string chain = "<bsdf type=\"diffuse\" id=\"b0\"/>", tree = chain, aliases = chain;
  for (int i = 1; i < 5000; ++i)
    chain += fmt::format("<bsdf type=\"twosided\" id=\"b{}\"><ref id=\"b{}\"/></bsdf>", i, i - 1);
  for (int i = 1; i < 60; ++i)
    tree += fmt::format("<bsdf type=\"blendbsdf\" id=\"b{0}\"><float name=\"weight\" value=\".5\"/><ref id=\"b{1}\"/>"
                        "<ref id=\"b{1}\"/></bsdf>",
                        i, i - 1);
  for (int i = 1; i < 100; ++i) aliases += fmt::format("<alias id=\"b{}\" as=\"b{}\"/>", i - 1, i);
  const auto cube = [](const char* id) { return fmt::format("<shape type=\"cube\"><ref id=\"{}\"/></shape>", id); };
  expect_in_body(chain + cube("b4999"), "nested more than");
  expect_in_body(tree + cube("b59"), "expected at most");
  expect_in_body(aliases + cube("b99"), "more than");
  expect_in_body("<spectrum name=\"c\" type=\"srgb\" id=\"s\"><ref id=\"s\" name=\"color\"/></spectrum>"
                 "<shape type=\"cube\"><bsdf type=\"diffuse\"><ref id=\"s\" name=\"reflectance\"/></bsdf></shape>",
                 "contains itself");
  expect_in_body("<integrator type=\"moment\" id=\"i\"><ref id=\"i\"/></integrator>", "contains itself");
  expect_complaint(scene("<texture type=\"scale\" id=\"t\"><ref id=\"t\"/></texture><shape type=\"cube\">"
                         "<bsdf type=\"bumpmap\"><ref id=\"t\"/><bsdf type=\"diffuse\"/></bsdf></shape>",
                         "0.6.0"),
                   "scene.xml:2", "contains itself");
}

TEST_F(BadInputLimits, TextThatMultiplies) {
  std::string defaults = "<default name=\"a0\" value=\"ha\"/>";
  for (int i = 1; i < 60; ++i) defaults += fmt::format("<default name=\"a{0}\" value=\"$a{1}-$a{1}-\"/>", i, i - 1);
  expect_in_body(defaults, "characters");
  for (int i = 0; i < 10; ++i) {  // 8^10 files
    std::string text = "<scene version=\"3.0.0\">";
    for (int k = 0; k < 8; ++k) text += fmt::format("<include filename=\"i{}.xml\"/>", i - 1);
    write(fmt::format("i{}.xml", i), i == 0 ? "<scene version=\"3.0.0\"/>" : text + "</scene>");
  }
  EXPECT_NE(complaint(scene("<include filename=\"i9.xml\"/>")).find("files are included"), std::string::npos);
  std::string many = "<shape type=\"cube\">";
  for (int i = 0; i < 100000; ++i) many += fmt::format("<float name=\"p{}\" value=\"1\"/>", i);
  expect_in_body(many + "</shape>", "no parameter p0");
  std::string folders;
  for (int i = 0; i < 2000; ++i) folders += "<path value=\".\"/>";
  expect_in_body(folders, "<path>");
  // A long value is not quoted as a whole.
  EXPECT_LT(complaint(scene("<shape type=\"" + std::string(1 << 20, 'x') + "\"/>")).size(), 10000);
  // Entities are not expanded.
  EXPECT_NO_THROW(load("<?xml version=\"1.0\"?><!DOCTYPE s [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]>" +
                       scene("<bsdf type=\"diffuse\" id=\"&b;\"/>")));
}

TEST_F(BadInputLimits, Numbers) {
  const auto sphere = [](const char* value) {
    return fmt::format("<shape type=\"sphere\"><float name=\"radius\" value=\"{}\"/></shape>", value);
  };
  for (const char* value : {"1e39", "-1e300", "1,5", "1 2", "--1", "1e", "+", "NaN", "-inf", "infinity", "1f", "\xd9\xa1"})
    expect_in_body(sphere(value), "a number");
  expect_in_body("<shape type=\"cube\"><emitter type=\"area\"><rgb name=\"radiance\" value=\"1e39\"/></emitter></shape>",
                 "numbers");
  expect_in_body("<shape type=\"cube\"><emitter type=\"area\"><spectrum name=\"radiance\" value=\"400:3e38, 700:3e38\"/>"
                 "</emitter></shape>",
                 "a float can hold");
}

TEST_F(BadInputLimits, Memory) {
  // 2^28 pixels take 19 GB; where that is there, the film is fine.
  std::string film = "<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"16384\"/>"
                     "<integer name=\"height\" value=\"16384\"/></film></sensor>";
  const std::string message = complaint(scene(film));
  EXPECT_TRUE(message.empty() || message.find("bytes of memory; ") != message.npos) << message;
  // A million instances of a hundred shapes.
  std::string group = "<shape type=\"shapegroup\" id=\"g\">";
  for (int i = 0; i < 100; ++i) group += "<shape type=\"disk\"/>";
  group += "</shape>";
  EXPECT_NO_THROW(load(scene(group + "<shape type=\"instance\"><ref id=\"g\"/></shape>")));
}

TEST_F(BadInputLimits, Meshes) {
  const auto shape = [](const char* type) {
    return fmt::format("<shape type=\"{0}\"><string name=\"filename\" value=\"m.{0}\"/></shape>", type);
  };
  // Half a million corners at one position, all different: must not take quadratic time.
  std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 1; i <= 100000; ++i) obj += fmt::format("vt {0} 0\nf 1/{0} 2/{0} 3/{0}\n", i);
  write("m.obj", obj + "f 1/1 2/70 3/99999\n");
  const Scene crowded = load(scene(shape("obj")));
  EXPECT_EQ(std::get<MeshShape>(crowded.shapes[0].kind).mesh->positions.size(), 300000u);
  // Rows without properties take no room in the file.
  const std::string vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                               "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                               "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  write("m.ply", "ply\nformat ascii 1.0\nelement nothing 9000000000000000000\n" + vertices);
  EXPECT_NO_THROW(load(scene(shape("ply"))));
  std::string wide = "ply\nformat ascii 1.0\nelement vertex 1\n";
  for (int i = 0; i < 5000; ++i) wide += fmt::format("property float p{}\n", i);
  write("m.ply", wide);
  expect_complaint(scene(shape("ply")), "m.ply:1004", "more than 1000 properties");
}

TEST_F(BadInputLimits, Images) {
  const auto complain = [&](const std::string& name, const std::string& content) {
    write(name, content);
    try {
      name.ends_with("exr") ? static_cast<void>(read_exr(folder_ / name)) : static_cast<void>(read_ldr(folder_ / name));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  // Fill bytes before the start of a JPEG hide it from a simple look, not from stb_image.
  const std::string table = "\xff\xc4" + std::string("\1\4", 2) + std::string(17, '\xff') + std::string(300, '\1');
  EXPECT_NE(complain("m.jpg", "\xff\xff\xd8" + table).find("Huffman"), std::string::npos);
  // A PNG chunk of 1 GB in a file of a few bytes.
  const std::string head("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\2\0\0\0\2\x08\0\0\0\0\x57\xdd\x52\xf8", 33);
  EXPECT_NE(complain("m.png", head + std::string("\x3f\0\0\0IDATx", 9)).find("cut short"), std::string::npos);
  // An EXR of several parts whose second header holds an attribute of 1.4 GB.
  const std::string exr("\x76\x2f\x31\x01\x02\x10\0\0a\0int\0\4\0\0\0\1\0\0\0\0b\0string\0\0\0\0\x50xxxx", 41);
  EXPECT_NE(complain("m.exr", exr).find("attribute is cut short"), std::string::npos);
}

TEST_F(BadInputLimits, FilesThatAreNone) {
  std::filesystem::create_directory(folder_ / "folder.obj");
  ASSERT_EQ(mkfifo((folder_ / "fifo.obj").c_str(), 0600), 0);
  std::filesystem::create_symlink("loop.obj", folder_ / "loop.obj");
  write("zero.obj", "");
  for (const char* name : {"folder.obj", "fifo.obj", "loop.obj", "none.obj", "/dev/zero"})
    expect_in_body(fmt::format("<shape type=\"obj\"><string name=\"filename\" value=\"{}\"/></shape>", name),
                   "does not exist");
  expect_in_body("<include filename=\"loop.obj\"/>", "does not exist");
  EXPECT_NE(complaint(scene("<include filename=\"fifo.obj\"/>")).find("not a regular file"), std::string::npos);
  EXPECT_NE(complaint(scene("<include filename=\"zero.obj\"/>")).find("broken XML"), std::string::npos);
}

TEST_F(BadInputLimits, Encodings) {
  std::string windows = "\xef\xbb\xbf" + scene("<shape type=\"cube\"/>\n");
  for (size_t i = windows.find('\n'); i != windows.npos; i = windows.find('\n', i + 2)) windows.insert(i, "\r");
  EXPECT_NO_THROW(load(windows));
  std::string wide = "\xff\xfe";  // UTF-16
  for (const char c : scene("<shape type=\"cube\"/>")) wide += {c, '\0'};
  std::string message;
  EXPECT_NO_THROW(message = complaint(wide));
  EXPECT_TRUE(message.empty() || message.starts_with("scene.xml:")) << message;
}

}  // namespace
}  // namespace tachylite
