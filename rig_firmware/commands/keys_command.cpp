#include "common/wire/keys_command.h"

#include "common/base/cli/command.h"

namespace vantage {

CommandEntry keys_command_entry() { return {add_keys_command}; }

}  // namespace vantage
