# aphotic_warnings: what every target of ours is compiled with.
# -Wconversion because a rounded wavelength or index is a wrong image, not a crash.
add_library(aphotic_warnings INTERFACE)
target_compile_options(aphotic_warnings INTERFACE
    -Wall -Wextra -Wconversion -Wshadow
    $<$<BOOL:${APHOTIC_WERROR}>:-Werror>)
