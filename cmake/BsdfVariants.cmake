# Kernels that shade surfaces come in variants, each with the bsdfs of some material classes only: what is in the
# SPIR-V costs time to compile even where specialization removes it (on lavapipe 1.6 s for all, 0.27 s for all fourteen
# kernels of scenes/table, whose classes have one type each). host/pack/pack_material.h, bsdf_kernel_variant, names the
# variant of a class.
#
#   tachylite_bsdf_variants(OUTPUT KERNEL FILE [MACROS...])
#
# appends to the list OUTPUT, for tachylite_kernel_library: KERNEL_TYPE and KERNEL_TYPE_textured for each type (single
# leaves), KERNEL_mixture (all types without textures) and KERNEL_mixture_textured (all but the principled two). FILE
# compiled without these, mixtures of everything, has textures, too. MACROS: of all of them.
function(tachylite_bsdf_variants output kernel file)
  # In the order of kBsdf... in shaders/shared/material.h, from 1 on.
  set(types diffuse rough_diffuse conductor rough_conductor dielectric thin_dielectric rough_dielectric plastic
      rough_plastic principled principled_thin blinn_phong microfacet)
  set(variants ${${output}})
  set(mask 1)
  foreach(type IN LISTS types)
    math(EXPR mask "2 * ${mask}")
    list(APPEND variants "${kernel}_${type} ${file} BSDF_TYPES=${mask} BSDF_SINGLE_LEAF BSDF_NO_TEXTURES ${ARGN}"
                         "${kernel}_${type}_textured ${file} BSDF_TYPES=${mask} BSDF_SINGLE_LEAF ${ARGN}")
  endforeach()
  list(APPEND variants "${kernel}_mixture ${file} BSDF_NO_TEXTURES ${ARGN}"
                       "${kernel}_mixture_textured ${file} BSDF_TYPES=0x33ff ${ARGN}")
  set(${output} ${variants} PARENT_SCOPE)
endfunction()
