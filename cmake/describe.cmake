set(description "unknown")
if(GIT)
    execute_process(COMMAND "${GIT}" describe --always --dirty --tags WORKING_DIRECTORY "${SOURCE}"
        OUTPUT_VARIABLE output ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE status)
    if(status EQUAL 0 AND output)
        set(description "${output}")
    endif()
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT [[
#include "ropsim_build.hpp"

namespace ropsim_build {

const std::string_view git_describe = "@description@";

} // namespace ropsim_build
]] @ONLY)
