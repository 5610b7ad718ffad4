# ropsim_build.hpp: what was built, and where the program finds its data and its modules.
set(ROPSIM_COMPILER "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
set(ROPSIM_BUILD_TYPE "${CMAKE_BUILD_TYPE}")
if(ROPSIM_SANITIZE)
    string(APPEND ROPSIM_BUILD_TYPE " (${ROPSIM_SANITIZE})")
endif()
configure_file("${PROJECT_SOURCE_DIR}/cmake/ropsim_build.hpp.in" "${PROJECT_BINARY_DIR}/generated/ropsim_build.hpp")
configure_file("${PROJECT_SOURCE_DIR}/cmake/ropsim_build.cpp.in" "${PROJECT_BINARY_DIR}/generated/ropsim_build.cpp")

# The description of the commit is asked for at every build and kept in a file of its own, so that a new commit
# recompiles this one file.
find_package(Git QUIET)
add_custom_target(ropsim_describe
    COMMAND ${CMAKE_COMMAND} -D "GIT=${GIT_EXECUTABLE}" -D "SOURCE=${PROJECT_SOURCE_DIR}"
        -D "OUTPUT=${PROJECT_BINARY_DIR}/generated/ropsim_describe.cpp" -P "${PROJECT_SOURCE_DIR}/cmake/describe.cmake"
    BYPRODUCTS "${PROJECT_BINARY_DIR}/generated/ropsim_describe.cpp"
    COMMENT "Asking git for a description of the commit")
