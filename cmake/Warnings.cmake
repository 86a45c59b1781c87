# Warnings of our own code; headers of libraries are system headers.
add_library(tachylite_warnings INTERFACE)
target_compile_options(tachylite_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                                                    -Wold-style-cast -Woverloaded-virtual -Wimplicit-fallthrough
                                                    -Wno-missing-field-initializers)  # Vulkan: {sType}
