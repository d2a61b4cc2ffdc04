#include "rig_firmware/capture/lent_picture.h"

#include "rig_firmware/capture/dma_buf_access.h"

namespace vantage {

ColourImage to_colour(const LentPicture& picture) {
    const DmaBufAccess access(picture.dma_buf);
    const ColourImage whole = to_colour(picture.raw);
    return whole.size() == picture.view.size() ? whole : ColourImage(whole(picture.view).clone());
}

}  // namespace vantage
