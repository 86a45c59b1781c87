// The one translation unit that holds the function pointers of Vulkan.
#define VOLK_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wpedantic"
#include <volk.h>
#pragma GCC diagnostic pop
