#include "host_app/commands/demo/demo_moves.h"

#include <algorithm>
#include <cassert>

namespace vantage {

std::string demo_move(std::string_view name) {
    const auto moves = demo_moves();
    const auto found = std::find_if(moves.begin(), moves.end(),
                                    [&](const EmbeddedText& move) { return move.name == name; });
    assert(found != moves.end());
    return std::string(found->text);
}

}  // namespace vantage
