#pragma once

#include "common/take/take_writer.h"
#include "common/wire/kept_parts.h"

namespace vantage {

/// A frame of a rig's own take with what another take has to know of it.
struct KeptFrame {
    TakeRig rig;
    double pulse_rate_hz = 30;
    int tai_offset_s = 0;
    StoredFrame frame;
};

/// As it travels: the head is JSON, the rest as in the file.
KeptParts encode(const KeptFrame& frame);
/// Takes nothing on trust: throws Error with one sentence for what is damaged, is not what its
/// record says, or would fit no track. Pictures are not decoded.
KeptFrame decode_kept_frame(const KeptParts& parts);

}  // namespace vantage
