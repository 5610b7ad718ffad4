# ropsim_layer(NAME [EXCLUDE regex] LINK targets...)
# The library ropsim_NAME (ropsim::NAME to others) of every .cpp below the current folder.
function(ropsim_layer name)
    cmake_parse_arguments(LAYER "" "EXCLUDE" "LINK" ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS "*.cpp")
    if(LAYER_EXCLUDE)
        list(FILTER sources EXCLUDE REGEX "${LAYER_EXCLUDE}")
    endif()
    if(NOT sources)
        set(sources "${CMAKE_CURRENT_BINARY_DIR}/empty.cpp")
        file(CONFIGURE OUTPUT "${sources}" CONTENT "// This layer has headers only.\n")
    endif()
    add_library(ropsim_${name} STATIC ${sources})
    add_library(ropsim::${name} ALIAS ropsim_${name})
    set_target_properties(ropsim_${name} PROPERTIES EXPORT_NAME ${name})
    target_compile_features(ropsim_${name} PUBLIC cxx_std_20)
    target_include_directories(ropsim_${name} PUBLIC
        $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
        $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>
        $<INSTALL_INTERFACE:include/ropsim>)
    target_link_libraries(ropsim_${name} PUBLIC ${LAYER_LINK} PRIVATE $<BUILD_INTERFACE:ropsim_compiler>)
    ropsim_unity(ropsim_${name})
    set_property(GLOBAL APPEND PROPERTY ROPSIM_LAYERS ropsim_${name})
endfunction()

# ropsim_unity(TARGET [BATCH]): compiles BATCH files (24) of a target together, where the build asks for it.
# Most of a file's compile time are the headers it includes and the templates it makes of them, so several files together
# take little longer than one. GCC then spends a tenth of its time on collecting garbage; 1 GB of it may lie about.
function(ropsim_unity target)
    set(batch 24)
    if(ARGC GREATER 1)
        set(batch ${ARGV1})
    endif()
    if(ROPSIM_UNITY)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
        target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)
    endif()
endfunction()

# ropsim_builds_fast(TARGET): for code in which no run spends its time; optimising it would be 40 % of its compile time.
function(ropsim_builds_fast target)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# ropsim_module(NAME FOLDER targets...): the sources of FOLDER as ropsim_NAME.so, loaded at run time when it is needed.
function(ropsim_module name folder)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${folder}/*.cpp")
    if(NOT sources)
        return()
    endif()
    add_library(ropsim_${name} MODULE ${sources})
    set_target_properties(ropsim_${name} PROPERTIES PREFIX ""
        LIBRARY_OUTPUT_DIRECTORY "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/ropsim")
    target_compile_features(ropsim_${name} PRIVATE cxx_std_20)
    target_include_directories(ropsim_${name} PRIVATE "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}/generated")
    target_link_libraries(ropsim_${name} PRIVATE ${ARGN} ropsim_compiler)
    set_property(GLOBAL APPEND PROPERTY ROPSIM_MODULES ropsim_${name})
endfunction()
