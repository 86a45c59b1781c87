# AddressSanitizer and UndefinedBehaviorSanitizer for every target, chosen by the preset `asan`.
if(TACHYLITE_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
# Coverage for libFuzzer; its programs link -fsanitize=fuzzer.
if(TACHYLITE_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
