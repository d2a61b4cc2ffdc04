#pragma once

#include "host_app/desk/desk_state.h"
#include "host_app/desk/feed/clip_pictures.h"
#include "host_app/programme/programme.h"

namespace vantage {

/// What the desk tells of clips and play list. `tai_offset_s`: as TimecodeClock's.
DeskReplay desk_replay(const ProgrammeState& programme, const ClipPictures& pictures,
                       int tai_offset_s);

}  // namespace vantage
