#pragma once

#include <cstdint>
#include <string>

#include "base/file_location.h"

namespace tachylite {

/// Bytes that this process can still have without swapping: what Linux calls available, at most the limit of the
/// process (RLIMIT_AS). The largest number where neither is known.
uint64_t available_memory();

/// To be asked before something that the user's input makes large is allocated. Throws InputError that gives needed
/// and available bytes where `bytes` are not available; `what` needs them: "the film of 4 x 3 pixels".
void require_memory(const FileLocation& where, const std::string& what, uint64_t bytes);

/// Asks the system to back memory that nobody has touched yet by pages of 2 MiB, where it may: hundreds of times fewer page
/// faults, and fewer misses of the TLB. Does nothing to less than that.
void prefer_huge_pages(void* begin, uint64_t bytes);

/// The most memory that this process has held at once since forget_peak_memory [bytes]; 0 where Linux does not tell.
uint64_t peak_memory();
void forget_peak_memory();

}  // namespace tachylite
