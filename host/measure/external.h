#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "measure/measurement.h"

namespace tachylite {

/// Another renderer: a command for /bin/sh that renders one image.
struct ExternalRenderer {
  std::string name, command;
  uint64_t most_samples = 0;  // levels beyond are left out; 0: none
};

/// Reads "name=cycles;spp=64;command=..." (command last; it may hold semicolons). In the command {scene} {samples}
/// {seed} {out} and {defines} (-D name=value ...) are replaced, quoted for the shell; {samples}, {seed} and {out} must
/// be there. Throws InputError.
ExternalRenderer parse_external(const std::string& specification);

/// The command with its words put in.
std::string fill_command(const ExternalRenderer& renderer, const std::map<std::string, std::string>& words);

/// Runs the command, reads the EXR that it leaves at `out`, and removes it. The CPU time is that of all processes that
/// it waited for. Where the last line that begins with '{' on its stdout holds render_cpu_seconds and
/// render_wall_seconds, those are the time of the samples alone; else the whole is. Throws RenderError, with the end
/// of what it wrote, when the command fails or leaves no image.
TimedImage run_external(const ExternalRenderer& renderer, const std::string& command, const std::filesystem::path& out);

}  // namespace tachylite
