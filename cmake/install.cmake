# `cmake --install`: the program, its data, and a CMake package `ropsim` with one target per layer (ropsim::pipeline).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(layers GLOBAL PROPERTY ROPSIM_LAYERS)
get_property(modules GLOBAL PROPERTY ROPSIM_MODULES)
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/ropsim")
set(data_dir "${CMAKE_INSTALL_DATADIR}/ropsim")

if(TARGET ropsim)
    install(TARGETS ropsim RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endif()
# The program looks for ../lib/ropsim and ../share/ropsim, seen from itself.
if(modules)
    install(TARGETS ${modules} LIBRARY DESTINATION lib/ropsim)
endif()
foreach(path models/gpus models/scenes reports/published reports/studies reports/result.schema.json LICENSE)
    if(IS_DIRECTORY "${PROJECT_SOURCE_DIR}/${path}")
        install(DIRECTORY "${path}/" DESTINATION "${data_dir}/${path}")
    elseif(EXISTS "${PROJECT_SOURCE_DIR}/${path}")
        cmake_path(GET path PARENT_PATH folder)
        install(FILES "${path}" DESTINATION "${data_dir}/${folder}")
    endif()
endforeach()
install(DIRECTORY traces/samples/ DESTINATION "${data_dir}/traces/samples" PATTERN "record.sh" EXCLUDE)
install(DIRECTORY models/programs/ DESTINATION "${data_dir}/models/programs" FILES_MATCHING PATTERN "*.kb"
    PATTERN "*.glsl" PATTERN "language" EXCLUDE)
if(EXISTS "${PROJECT_SOURCE_DIR}/cli/completion.bash")
    install(FILES cli/completion.bash DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" RENAME ropsim)
endif()

install(TARGETS ${layers} EXPORT ropsim ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
foreach(layer sim pipeline models traces reports)
    install(DIRECTORY "${layer}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/ropsim" FILES_MATCHING PATTERN "*.hpp"
        PATTERN "*_module" EXCLUDE PATTERN "scenes" EXCLUDE PATTERN "gpus" EXCLUDE)
endforeach()
install(FILES "${PROJECT_BINARY_DIR}/generated/ropsim_build.hpp" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/ropsim")
install(EXPORT ropsim NAMESPACE ropsim:: FILE ropsimTargets.cmake DESTINATION "${package_dir}")
configure_package_config_file(cmake/ropsimConfig.cmake.in "${PROJECT_BINARY_DIR}/ropsimConfig.cmake"
    INSTALL_DESTINATION "${package_dir}" PATH_VARS data_dir)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/ropsimConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/ropsimConfig.cmake" "${PROJECT_BINARY_DIR}/ropsimConfigVersion.cmake"
    DESTINATION "${package_dir}")
