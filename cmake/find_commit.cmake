# Writes OUTPUT, which defines vantage::commit() as the commit of the sources in SOURCE; empty outside a checkout.
set(commit "")
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
"#include <string_view>
namespace vantage {
std::string_view commit();
std::string_view commit() { return \"${commit}\"; }
}  // namespace vantage
")
