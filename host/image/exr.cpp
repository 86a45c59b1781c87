#include "image/exr.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include "base/atomic_file.h"
#include "base/check.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/read_file.h"
#include "image/exr_header.h"
#include "image/film.h"

namespace tachylite {
namespace {

/// A slice that reads or writes all of `values` (float or uint32_t) as the channel over the window that starts at
/// (min_x, min_y).
template <class T>
Imf::Slice make_slice(T* values, size_t width, int min_x, int min_y) {
  static_assert(sizeof(T) == 4);
  // OpenEXR addresses pixel (x, y) as base + x * xStride + y * yStride in absolute coordinates.
  const auto x0 = static_cast<ptrdiff_t>(min_x), y0 = static_cast<ptrdiff_t>(min_y);
  char* base = reinterpret_cast<char*>(values) -
               (x0 + y0 * static_cast<ptrdiff_t>(width)) * static_cast<ptrdiff_t>(sizeof(T));
  return Imf::Slice(std::is_same_v<T, float> ? Imf::FLOAT : Imf::UINT, base, sizeof(T), width * sizeof(T));
}

/// A file that throws where writing fails; OpenEXR's own does not see what fails when the file is closed.
class CheckedFile : public Imf::OStream {
 public:
  explicit CheckedFile(const std::filesystem::path& path)
      : OStream(path.c_str()), file_(std::fopen(path.c_str(), "wb")) {
    require(file_ != nullptr);
  }
  ~CheckedFile() override {
    if (file_) std::fclose(file_);
  }
  void write(const char* bytes, int count) override {
    require(std::fwrite(bytes, 1, static_cast<size_t>(count), file_) == static_cast<size_t>(count));
  }
  uint64_t tellp() override { return static_cast<uint64_t>(std::ftell(file_)); }
  void seekp(uint64_t position) override {
    require(std::fseek(file_, static_cast<long>(position), SEEK_SET) == 0);
  }
  /// Throws also for what failed before: destructors of OpenEXR swallow it.
  void close() {
    std::FILE* file = file_;
    file_ = nullptr;
    require(std::fclose(file) == 0 && failure_ == 0);
  }

 private:
  void require(bool done) {
    if (done) return;
    if (failure_ == 0) failure_ = errno;
    throw std::runtime_error(std::strerror(failure_));
  }
  int failure_ = 0;
  std::FILE* file_;
};

bool holds_words(const std::string& name, Imf::PixelType type) {
  return type == Imf::UINT && (name.starts_with(kSumsLayer) || name.starts_with(kSquaresLayer));
}

/// Width and height of the window, or an InputError when it is absurd.
std::pair<size_t, size_t> window_size(const FileLocation& where, const Imath::Box2i& window, size_t channels,
                                      size_t max_pixels) {
  const int64_t w = int64_t{window.max.x} - window.min.x + 1, h = int64_t{window.max.y} - window.min.y + 1;
  if (w < 1 || h < 1) throw InputError(where, "the EXR image is empty");
  const auto width = static_cast<size_t>(w), height = static_cast<size_t>(h);
  if (width > max_pixels / height)
    throw InputError(where,
                     fmt::format("the EXR image has {} x {} pixels; at most {} are read", w, h, max_pixels));
  if (width * height > 4 * max_pixels / channels)
    throw InputError(where, fmt::format("the EXR image has {} channels of {} x {} pixels; that is too large",
                                        channels, w, h));
  return {width, height};
}

Image read_part(const FileLocation& where, const std::filesystem::path& path, size_t max_pixels) {
  if (Imf::MultiPartInputFile parts(path.c_str()); parts.parts() != 1)
    throw InputError(where, fmt::format("the EXR file has {} parts, expected one", parts.parts()));
  Imf::InputFile input(path.c_str());
  const Imf::Header& header = input.header();

  // Name and check the channels.
  Image image;
  image.half = true;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
      throw InputError(where, fmt::format("channel {} of the EXR file is subsampled; that is not supported",
                                          channel.name()));
    if (holds_words(channel.name(), channel.channel().type)) {
      image.word_names.emplace_back(channel.name());
      continue;
    }
    image.half = image.half && channel.channel().type == Imf::HALF;
    image.names.emplace_back(channel.name());
  }
  if (image.names.empty()) throw InputError(where, "the EXR file has no channels");

  // Read all of them at once; all but the words are widened to float.
  const Imath::Box2i window = header.dataWindow();
  const size_t channels = image.names.size() + image.word_names.size();
  const auto [width, height] = window_size(where, window, channels, max_pixels);
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  // No compression packs more than this; a small file must not take all memory.
  constexpr uintmax_t kMostPerByte = uintmax_t{1} << 17;
  if (width * height * channels > kMostPerByte * std::filesystem::file_size(path))
    throw InputError(where, "the EXR file is cut short");
  require_memory(where, fmt::format("the EXR image of {} x {} pixels", width, height),
                 2 * sizeof(float) * channels * width * height);
  Imf::FrameBuffer frame;
  image.channels.resize(image.names.size());
  for (size_t i = 0; i < image.names.size(); ++i) {
    image.channels[i].resize(width * height);
    frame.insert(image.names[i], make_slice(image.channels[i].data(), width, window.min.x, window.min.y));
  }
  image.words.resize(image.word_names.size());
  for (size_t i = 0; i < image.word_names.size(); ++i) {
    image.words[i].resize(width * height);
    frame.insert(image.word_names[i], make_slice(image.words[i].data(), width, window.min.x, window.min.y));
  }
  input.setFrameBuffer(frame);
  input.readPixels(window.min.y, window.max.y);

  for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
      image.metadata[attribute.name()] = text->value();
  return image;
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Image& image) {
  CHECK(image.width > 0 && image.height > 0);
  CHECK_EQ(image.names.size(), image.channels.size());
  const auto width = static_cast<size_t>(image.width), height = static_cast<size_t>(image.height);
  write_atomically(file, [&](const std::filesystem::path& beside) {
    try {
      if (Imf::globalThreadCount() < thread_count()) Imf::setGlobalThreadCount(thread_count());
      Imf::Header header(image.width, image.height);
      header.compression() = Imf::ZIP_COMPRESSION;
      header.zipCompressionLevel() = 1;  // 1.5 % larger than by default, in two thirds of the time
      for (const auto& [name, text] : image.metadata) header.insert(name, Imf::StringAttribute(text));
      Imf::FrameBuffer frame;
      for (size_t i = 0; i < image.names.size(); ++i) {
        CHECK_EQ(image.channels[i].size(), width * height);
        header.channels().insert(image.names[i], Imf::Channel(Imf::FLOAT));
        // Imf::Slice takes a char* for reading, too; writePixels only reads from it.
        frame.insert(image.names[i], make_slice(const_cast<float*>(image.channels[i].data()), width, 0, 0));
      }
      for (size_t i = 0; i < image.word_names.size(); ++i) {
        CHECK_EQ(image.words[i].size(), width * height);
        header.channels().insert(image.word_names[i], Imf::Channel(Imf::UINT));
        frame.insert(image.word_names[i], make_slice(const_cast<uint32_t*>(image.words[i].data()), width, 0, 0));
      }
      CheckedFile stream(beside);
      {
        Imf::OutputFile output(stream, header, thread_count());
        output.setFrameBuffer(frame);
        output.writePixels(image.height);
      }  // writes the table of lines
      stream.close();
    } catch (const std::exception& failure) {
      throw RenderError(fmt::format("cannot write {}: {}", file.string(), failure.what()));
    }
  });
}

Image read_exr(const std::filesystem::path& file, size_t max_pixels) {
  const FileLocation where = locate_file(file);
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) throw InputError(where, "no such file");
  try {
    check_exr_header(where, file);
    return read_part(where, file, max_pixels);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& failure) {
    throw InputError(where, fmt::format("not a readable EXR file: {}", failure.what()));
  }
}

}  // namespace tachylite
