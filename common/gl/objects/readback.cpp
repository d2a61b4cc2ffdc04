#include "common/gl/objects/readback.h"

#include "common/gl/context/limits.h"

namespace vantage {

void Readback::begin(const Texture& texture) {
    const Framebuffer framebuffer({&texture});
    format_ = texture.format();
    size_ = texture.size();
    const auto read = [&](const PixelLayout& layout) {
        layout_ = layout;
        const auto bytes = static_cast<std::size_t>(size_.area()) * CV_ELEM_SIZE(layout.cv_type);
        if (!buffer_ || buffer_->bytes() != bytes) buffer_.emplace(bytes, GL_STREAM_READ);
        buffer_->bind(GL_PIXEL_PACK_BUFFER);
        glReadPixels(0, 0, size_.width, size_.height, layout.format, layout.type, nullptr);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    };
    framebuffer.read_with(0, read);
    fence_ = Fence::insert();
}

cv::Mat Readback::take(cv::Mat pixels, std::chrono::nanoseconds limit) {
    CV_Assert(layout_);
    fence_.wait("a picture was read back", limit);
    fence_ = {};
    pixels.create(size_, layout_->cv_type);
    buffer_->read(0,
                  {reinterpret_cast<std::byte*>(pixels.data), pixels.total() * pixels.elemSize()});
    layout_.reset();
    check_gl("reading a picture back");
    return in_format(pixels, format_);
}

}  // namespace vantage
