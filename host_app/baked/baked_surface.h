#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/texture.h"
#include "host_app/baked/bake.h"
#include "host_app/surfaces/instant.h"

namespace vantage {

/// A baked background on the GPU. Made on the GL context that prepares instants; any context that
/// shares objects may draw it. It does not change while an instant refers to it.
class BakedSurface {
  public:
    struct Part {
        Buffer vertices, indices;
        int measured = 0, all = 0;  ///< number of indices
        std::array<int, BakedPart::max_sources> sources{};
        Texture weights;
        Eigen::Matrix3d K;  ///< of the owner's depth map
        Pose world_from_owner;
        Eigen::Vector3d middle;  ///< mean of the vertices, in the world

        Part(const BakedPart& part, const DepthView& owner);
    };
    struct View {
        DepthView camera;  ///< without pictures
        Texture colour;    ///< rgba8, with mip levels

        explicit View(const DepthView& view);
    };

    /// Replaces the content.
    void upload(const BakedBackground& baked);

    const std::vector<View>& views() const { return views_; }
    const std::vector<Part>& parts() const { return parts_; }
    int triangles() const;

  private:
    std::vector<View> views_;
    std::vector<Part> parts_;
};

/// The baked background of an instant, for the renderer.
struct BakedInstant : InstantExtra {
    std::shared_ptr<const BakedSurface> background;
    /// For each view of the background the rig's surface with its newest colours; null: the rig is
    /// away, and the colours are those that were baked.
    std::vector<std::shared_ptr<const RigSurface>> colours;
};

}  // namespace vantage
