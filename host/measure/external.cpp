#include "measure/external.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/timer.h"
#include "image/exr.h"
#include "measure/image_error.h"

namespace tachylite {
namespace {

std::string quoted(const std::string& word) {
  std::string result = "'";
  for (char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

double seconds_of(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

struct Finished {
  int status = 0;
  Seconds seconds;
  std::string out;  // stdout and stderr together
};

Finished run_shell(const std::string& command) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw RenderError(fmt::format("pipe: {}", std::strerror(errno)));
  const Timer timer;
  const pid_t child = fork();
  if (child < 0) throw RenderError(fmt::format("fork: {}", std::strerror(errno)));
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[1]);
  Finished result;
  char buffer[4096];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) != 0;) {
    if (n > 0) result.out.append(buffer, static_cast<size_t>(n));
    if (n < 0 && errno != EINTR) break;
  }
  close(ends[0]);
  rusage usage{};
  while (wait4(child, &result.status, 0, &usage) < 0 && errno == EINTR) {
  }
  result.seconds = {seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime), timer.seconds()};
  return result;
}

/// Its last words, on one line.
std::string end_of(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  constexpr size_t kMost = 300;
  if (text.size() > kMost) text = "..." + text.substr(text.size() - kMost);
  std::replace_if(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

Seconds rendering_of(const Finished& run) {
  size_t end = run.out.size();
  while (end > 0) {
    const size_t begin = run.out.rfind('\n', end - 1) == std::string::npos ? 0 : run.out.rfind('\n', end - 1) + 1;
    if (run.out[begin] == '{') {
      const auto json = nlohmann::json::parse(run.out.substr(begin, end - begin), nullptr, false);
      const auto figure = [&](const char* name) {
        return json.is_object() && json.contains(name) && json[name].is_number() ? json[name].get<double>() : 0.0;
      };
      const Seconds seconds{figure("render_cpu_seconds"), figure("render_wall_seconds")};
      if (seconds.cpu > 0 && seconds.wall > 0) return seconds;
    }
    if (begin == 0) break;
    end = begin - 1;
  }
  return run.seconds;
}

}  // namespace

ExternalRenderer parse_external(const std::string& specification) {
  ExternalRenderer renderer;
  std::string rest = specification;
  while (!rest.empty()) {
    const size_t equals = rest.find('=');
    if (equals == std::string::npos)
      throw InputError(fmt::format("--external: expected name=NAME;command=COMMAND, but found \"{}\"", rest));
    const std::string key = rest.substr(0, equals);
    const size_t end = key == "command" ? std::string::npos : rest.find(';', equals);
    const std::string text = rest.substr(equals + 1, end == std::string::npos ? end : end - equals - 1);
    rest = end == std::string::npos ? "" : rest.substr(end + 1);
    if (key == "name") {
      renderer.name = text;
    } else if (key == "command") {
      renderer.command = text;
    } else if (key == "spp") {
      const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), renderer.most_samples);
      if (error != std::errc() || last != text.data() + text.size() || renderer.most_samples == 0)
        throw InputError(fmt::format("--external: spp={} is not a number of samples", text));
    } else {
      throw InputError(fmt::format("--external: expected name, spp or command, but found {}", key));
    }
  }
  if (renderer.name.empty()) throw InputError("--external: the renderer has no name");
  if (renderer.name == "tachylite") throw InputError("--external: tachylite is the name of this renderer");
  for (const char* word : {"{samples}", "{seed}", "{out}"})
    if (renderer.command.find(word) == std::string::npos)
      throw InputError(fmt::format("--external {}: the command has no {}", renderer.name, word));
  return renderer;
}

std::string fill_command(const ExternalRenderer& renderer, const std::map<std::string, std::string>& words) {
  std::string command;
  for (size_t i = 0; i < renderer.command.size();) {
    const size_t end = renderer.command[i] == '{' ? renderer.command.find('}', i) : std::string::npos;
    const auto word = end == std::string::npos ? words.end() : words.find(renderer.command.substr(i + 1, end - i - 1));
    if (word == words.end()) {
      command += renderer.command[i++];
      continue;
    }
    command += word->first == "defines" ? word->second : quoted(word->second);
    i = end + 1;
  }
  return command;
}

TimedImage run_external(const ExternalRenderer& renderer, const std::string& command,
                        const std::filesystem::path& out) {
  const Finished run = run_shell(command);
  const auto fail = [&](const std::string& what) {
    throw RenderError(fmt::format("{}: {}: {}", renderer.name, what, end_of(run.out)));
  };
  if (WIFSIGNALED(run.status)) fail(fmt::format("ended by signal {}", WTERMSIG(run.status)));
  if (WEXITSTATUS(run.status) != 0) fail(fmt::format("ended with exit code {}", WEXITSTATUS(run.status)));
  if (!std::filesystem::is_regular_file(out)) fail("left no image");
  TimedImage result;
  try {
    result.image = color_of(read_exr(out));
  } catch (const InputError& error) {
    fail(error.what());
  }
  std::filesystem::remove(out);
  for (const std::vector<float>& channel : result.image.channels)
    if (!std::all_of(channel.begin(), channel.end(), [](float v) { return std::isfinite(v); }))
      fail("its image holds values that are not finite");
  result.render = rendering_of(run);
  result.total = run.seconds;
  return result;
}

}  // namespace tachylite
