#include "host_app/output/media/picture_converter.h"

#include <cassert>

#include "common/base/error.h"

extern "C" {
#include <libavutil/pixdesc.h>
}

namespace vantage {

PictureConverter::PictureConverter(int width_px, int height_px, AVPixelFormat format)
    : context_(sws_getContext(width_px, height_px, AV_PIX_FMT_RGBA, width_px, height_px, format,
                              SWS_BILINEAR | SWS_ACCURATE_RND, nullptr, nullptr, nullptr)),
      frame_(av_frame_alloc()) {
    if (!context_ || !frame_)
        fail("pictures of {}x{} cannot be made {}", width_px, height_px,
             av_get_pix_fmt_name(format));
    constexpr int full_range = 1, studio_range = 0, unchanged = 1 << 16;
    sws_setColorspaceDetails(context_.get(), sws_getCoefficients(SWS_CS_ITU709), full_range,
                             sws_getCoefficients(SWS_CS_ITU709), studio_range, 0, unchanged,
                             unchanged);
    frame_->format = format;
    frame_->width = width_px;
    frame_->height = height_px;
    frame_->colorspace = AVCOL_SPC_BT709;
    frame_->color_primaries = AVCOL_PRI_BT709;
    frame_->color_trc = AVCOL_TRC_BT709;
    frame_->color_range = AVCOL_RANGE_MPEG;
    if (av_frame_get_buffer(frame_.get(), 0) < 0) fail("memory is short");
}

AVFrame& PictureConverter::convert(const ColourImage& picture) {
    assert(picture.cols >= frame_->width && picture.rows >= frame_->height);
    // An encoder may still hold a reference to the last frame.
    if (av_frame_make_writable(frame_.get()) < 0) fail("memory is short");
    const std::uint8_t* rows[] = {picture.data};
    const int strides[] = {static_cast<int>(picture.step)};
    sws_scale(context_.get(), rows, strides, 0, frame_->height, frame_->data, frame_->linesize);
    return *frame_;
}

}  // namespace vantage
