# GLSL kernels -> SPIR-V, validated, inside a static library.
#
#   tachylite_kernel_library(TARGET FUNCTION FILES a.comp b.comp ...
#                            [VARIANTS "name file.comp MACRO OTHER=1" ...] [OPTIMISE regex])
#
# makes the library TARGET, and the header FUNCTION.h with
#   std::span<const uint32_t> tachylite::FUNCTION(std::string_view name);   // words of SPIR-V
#   std::span<const std::string_view> tachylite::FUNCTION_names();
# A file's kernel bears the file's name without its ending; a variant is the file compiled once more, under `name`,
# with macros. Includes are found beside the including file and under shaders/, and are tracked. spirv-opt prepares all
# kernels for drivers, which then take a third of the time; those whose name matches `regex` with all that it has.
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)
find_program(SPIRV_OPT spirv-opt REQUIRED)

# One function, with variables of scalars that are loaded as seldom as can be. Nothing that rewrites arithmetic: images
# keep their bits, and sums without rounding errors stay that. --ssa-rewrite takes 20 s for the largest kernel.
set(_tachylite_spirv_passes
  --merge-return --inline-entry-points-exhaustive --eliminate-dead-functions --scalar-replacement=100
  --convert-local-access-chains --eliminate-local-single-block --eliminate-local-single-store
  --eliminate-dead-code-aggressive)

# Compiles one kernel; appends its .spv and the stamp of its validation to `outputs` of the caller.
function(_tachylite_compile_kernel folder name file)
  list(TRANSFORM ARGN PREPEND -D OUTPUT_VARIABLE macros)
  set(spirv ${folder}/${name}.spv)
  set(passes ${_tachylite_spirv_passes})
  if(arg_OPTIMISE AND name MATCHES "${arg_OPTIMISE}")
    set(passes -O)
  endif()
  add_custom_command(OUTPUT ${spirv}
    COMMAND ${GLSLANG_VALIDATOR} --quiet --target-env vulkan1.3 -g0 -I${PROJECT_SOURCE_DIR}/shaders ${macros}
            --depfile ${spirv}.d -o ${spirv} ${file}
    COMMAND ${SPIRV_OPT} --target-env=vulkan1.3 ${passes} ${spirv} -o ${spirv}
    DEPENDS ${file} DEPFILE ${spirv}.d COMMENT "Kernel ${name}" VERBATIM)
  # A command of its own: a kernel that does not validate must fail again in the next build.
  add_custom_command(OUTPUT ${spirv}.valid
    COMMAND ${SPIRV_VAL} --target-env vulkan1.3 ${spirv}
    COMMAND ${CMAKE_COMMAND} -E touch ${spirv}.valid
    DEPENDS ${spirv} COMMENT "" VERBATIM)
  set(outputs ${outputs} ${spirv} ${spirv}.valid PARENT_SCOPE)
endfunction()

function(tachylite_kernel_library target function)
  cmake_parse_arguments(arg "" "OPTIMISE" "FILES;VARIANTS" ${ARGN})
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${target}.dir)
  file(MAKE_DIRECTORY ${folder})
  set(outputs "")
  set(names "")
  foreach(file IN LISTS arg_FILES)
    cmake_path(GET file STEM name)
    list(APPEND names ${name})
    _tachylite_compile_kernel(${folder} ${name} ${file})
  endforeach()
  foreach(variant IN LISTS arg_VARIANTS)
    separate_arguments(words UNIX_COMMAND "${variant}")
    list(POP_FRONT words name file)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    list(APPEND names ${name})
    _tachylite_compile_kernel(${folder} ${name} ${file} ${words})
  endforeach()

  set(KERNEL_FUNCTION ${function})
  set(KERNEL_SYMBOLS "")
  set(KERNEL_ROWS "")
  set(KERNEL_NAMES "")
  foreach(name IN LISTS names)
    string(APPEND KERNEL_SYMBOLS "EMBED(${function}_${name}, \"${folder}/${name}.spv\")\n")
    string(APPEND KERNEL_ROWS "    {\"${name}\", ${function}_${name}_begin, ${function}_${name}_end},\n")
    string(APPEND KERNEL_NAMES "    \"${name}\",\n")
  endforeach()
  configure_file(${PROJECT_SOURCE_DIR}/cmake/kernel_library.h.in ${folder}/${function}.h @ONLY)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/kernel_library.cpp.in ${folder}/${function}.cpp @ONLY)
  # The assembler reads the .spv, unseen by the compiler's own dependency scan.
  set_source_files_properties(${folder}/${function}.cpp PROPERTIES OBJECT_DEPENDS "${outputs}")
  add_library(${target} STATIC ${folder}/${function}.cpp)
  target_include_directories(${target} PUBLIC ${folder})
  target_link_libraries(${target} PRIVATE tachylite_base)
endfunction()
