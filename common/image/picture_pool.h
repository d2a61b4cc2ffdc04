#pragma once

#include <memory>

#include "common/image/image.h"

namespace vantage {

/// Memory for pictures of one kind, used again when nobody holds the picture any more: the system
/// gives large blocks page by page, which takes longer than many a thing that is done with them.
/// Pictures come back from any thread, and may outlive the pool.
class PicturePool {
  public:
    PicturePool();
    ~PicturePool();

    /// With whatever was in it before. Those of the size before, if that was another, are not kept.
    template <class Image>
    Image take(cv::Size size) {
        return take(size, cv::traits::Type<typename Image::value_type>::value);
    }

  private:
    cv::Mat take(cv::Size size, int type);

    class Shelf;
    std::shared_ptr<Shelf> shelf_;
};

}  // namespace vantage
