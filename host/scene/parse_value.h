#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace tachylite {

/// The whole of `text`, white space around it aside, as a finite number. A leading '+' is allowed.
std::optional<double> parse_real(std::string_view text);
std::optional<int64_t> parse_integer(std::string_view text);
/// "true" or "false" in any case.
std::optional<bool> parse_boolean(std::string_view text);

/// The parts of a list separated by commas, white space or both.
std::vector<std::string_view> split_list(std::string_view text);

/// A list of finite numbers, or nothing if one of them does not parse.
std::optional<std::vector<double>> parse_reals(std::string_view text);

}  // namespace tachylite
