#include "host_app/replay/clip.h"

namespace vantage {

ClipPresence presence_of(const Clip& clip, const std::optional<PastFrameSets::Span>& span) {
    if (!span || clip.out <= span->oldest || clip.in > span->newest) return ClipPresence::gone;
    const bool is_whole = clip.in >= span->oldest && clip.out <= span->newest + 1;
    return is_whole ? ClipPresence::whole : ClipPresence::part;
}

}  // namespace vantage
