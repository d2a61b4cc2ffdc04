#pragma once

#include <memory>
#include <optional>

#include "common/gl/objects/texture.h"
#include "host_app/programme/picture_maker.h"

namespace vantage {

/// The newest of a camera's pictures as a texture, of the context that is current.
class ShownPicture {
  public:
    /// Null as long as there is none.
    const Texture* follow(const std::shared_ptr<const MadePicture>& newest);

  private:
    std::optional<Texture> texture_;
    std::shared_ptr<const MadePicture> uploaded_;
};

}  // namespace vantage
