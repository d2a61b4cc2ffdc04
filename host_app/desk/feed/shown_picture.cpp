#include "host_app/desk/feed/shown_picture.h"

namespace vantage {

const Texture* ShownPicture::follow(const std::shared_ptr<const MadePicture>& newest) {
    if (newest == uploaded_) return uploaded_ ? &*texture_ : nullptr;
    uploaded_ = newest;
    if (!uploaded_) return nullptr;
    const ColourImage& shown =
        uploaded_->sources ? uploaded_->sources->picture : uploaded_->picture;
    if (!texture_ || texture_->size() != shown.size())
        texture_.emplace(TextureFormat::rgba8, shown.cols, shown.rows, Filter::linear);
    texture_->upload(shown);
    return &*texture_;
}

}  // namespace vantage
