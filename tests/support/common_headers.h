#pragma once

// What most tests include, compiled once for all (CMakeLists.txt). Nothing includes it, and no test relies on it.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include "support/render_test.h"
