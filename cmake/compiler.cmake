set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

# Checks stay in every build: no -DNDEBUG.
set(CMAKE_CXX_FLAGS_RELEASE "-O2")
set(CMAKE_CXX_FLAGS_DEBUG "-O0 -g")

# Linked by our own targets only. It is not exported: whoever uses an installed ropsim chooses their own warnings.
add_library(ropsim_compiler INTERFACE)
target_compile_options(ropsim_compiler INTERFACE -Wall -Wextra -Wpedantic -Wconversion)
if(NOT ROPSIM_UNITY) # there, a file's own name may be a local one of its neighbour
    target_compile_options(ropsim_compiler INTERFACE -Wshadow)
endif()
if(ROPSIM_WERROR)
    target_compile_options(ropsim_compiler INTERFACE -Werror)
endif()
# Pictures must not depend on the compiler: a*b+c is rounded twice, everywhere.
target_compile_options(ropsim_compiler INTERFACE -ffp-contract=off)

if(ROPSIM_SANITIZE)
    add_compile_options(-fsanitize=${ROPSIM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -O1) # a report names functions; -g1 adds lines
    add_link_options(-fsanitize=${ROPSIM_SANITIZE})
endif()
if(ROPSIM_FUZZ)
    add_compile_options(-fsanitize=fuzzer-no-link) # what is fuzzed reports which of its branches were taken
endif()
if(ROPSIM_SANITIZE OR CMAKE_BUILD_TYPE STREQUAL "Debug")
    add_compile_definitions(_GLIBCXX_ASSERTIONS)
endif()
