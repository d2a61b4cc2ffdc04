#pragma once

#include "common/take/take_writer.h"
#include "common/wire/kept_parts.h"

namespace vantage {

/// A frame of a rig's own recording, with the data that another take needs.
struct KeptFrame {
    TakeRig rig;
    double pulse_rate_hz = 30;
    int tai_offset_s = 0;
    StoredFrame frame;
};

/// The transport form: the head is JSON, the rest as in the file.
KeptParts encode(const KeptFrame& frame);
/// Decodes an untrusted frame. Throws Error with one sentence if it is damaged, contradicts its
/// record, or fits no track. Images are not decoded.
KeptFrame decode_kept_frame(const KeptParts& parts);

}  // namespace vantage
