#include "host_app/programme/view_painter.h"

#include <algorithm>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "common/base/log.h"
#include "common/base/time/time.h"
#include "common/base/trace/trace.h"
#include "common/gl/context/context_loss.h"
#include "common/gl/context/limits.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {
namespace {

/// Distances are measured on a coarse grid, which is fast.
constexpr int cells_a_row = 80;
constexpr float first_cells = cells_a_row / 20.0f, last_cells = cells_a_row / 10.0f;
constexpr int stripes_a_row = 60;
const cv::Vec3f dark(26, 28, 32), light(44, 47, 53);

bool is_unseen(const cv::Vec4b& pixel) {
    constexpr unsigned char min_seen = 128;
    return pixel[3] < min_seen && pixel[3] != remembered_alpha;
}

/// Distances to the nearest pixel that was seen, in cells.
cv::Mat1f distances_to_seen(const ColourImage& picture, int cell_px) {
    cv::Mat1b unseen((picture.rows + cell_px - 1) / cell_px,
                     (picture.cols + cell_px - 1) / cell_px);
    for (int y = 0; y < unseen.rows; ++y)
        for (int x = 0; x < unseen.cols; ++x)
            unseen(y, x) = is_unseen(picture(std::min(y * cell_px + cell_px / 2, picture.rows - 1),
                                             std::min(x * cell_px + cell_px / 2, picture.cols - 1)))
                               ? 255
                               : 0;
    cv::Mat1f distances;
    cv::distanceTransform(unseen, distances, cv::DIST_L2, 3);
    return distances;
}

}  // namespace

VirtualView view_of(const CameraState& camera, cv::Size size) {
    return {size.width, size.height, camera.K(size.width, size.height), camera.world_from_camera};
}

ViewPainter::ViewPainter(const SynthesiserEntry& synthesiser, const PictureFormat& format,
                         const ShaderLibrary& shaders)
    : format_(format),
      renderer_(synthesiser.make_renderer(shaders)),
      overlay_(shaders),
      mosaic_(shaders),
      coarse_depth_(shaders) {}

const Texture& ViewPainter::render(const Instant& instant, const CameraState& camera, cv::Size size,
                                   const RenderLevel& level, bool is_map) {
    const VirtualView target = view_of(camera, size);
    const std::string lacking = renderer_->lacks(instant, target);
    if (lacking != lacking_ && !lacking.empty()) log_warning("{}", lacking);
    lacking_ = lacking;
    const auto eye = [&](const VirtualView& view) -> const Texture& {
        const Texture& plain = renderer_->render(instant, view, level);
        last_eye_ = &plain;
        const PixelOrigins* origins = is_map ? renderer_->origins() : nullptr;
        return origins ? overlay_.lay(plain, *origins) : plain;
    };
    if (!format_.stereoscopy) return eye(target);
    const Stereoscopy settled = format_.stereoscopy->settled(target, camera.focus_m);
    mosaic_.begin(size, settled);
    const std::vector<VirtualView> eyes = eye_views(target, settled);
    for (std::size_t i = 0; i < eyes.size(); ++i) mosaic_.put(eye(eyes[i]), i);
    return mosaic_.picture();
}

ColourImage ViewPainter::paint(const Instant& instant, const CameraState& camera,
                               const RenderLevel& level, std::optional<SourceMap>* sources,
                               cv::Mat1f* inverse_depth) {
    const cv::Size full(format_.width_px, format_.height_px);
    const cv::Size size =
        format_.stereoscopy
            ? format_.stereoscopy->rendered_size(full, level.scale)
            : cv::Size(cvRound(full.width * level.scale), cvRound(full.height * level.scale));
    TraceSpan rendering("render");
    const Texture& texture = render(instant, camera, size, level, false);
    check_gl("rendering the virtual view");
    // The readback is queued before this thread waits for the frame.
    const Fence drawn = Fence::insert();
    readback_.begin(texture);
    if (const Texture* depth_m = renderer_->depth_m();
        depth_m && inverse_depth && !format_.stereoscopy)
        coarse_depth_.begin(*depth_m);
    rendering.end();
    TraceSpan waiting("fence wait");
    drawn.wait("waiting for a frame");
    waiting.end();
    const TraceSpan reading("readback");
    const MonotonicTime start = MonotonicClock::now();
    ColourImage picture = readback_.take(size == full ? pictures_.take<ColourImage>(full) : small_);
    if (coarse_depth_.is_begun()) *inverse_depth = coarse_depth_.take();
    require_context("reading back a frame");
    mark_unseen(picture);
    if (size != full) {
        small_ = std::exchange(picture, pictures_.take<ColourImage>(full));
        cv::resize(small_, picture, full, 0, 0, cv::INTER_CUBIC);
    }
    readback_ms_ = ms_since(start);
    if (sources && renderer_->note_origins(true)) {
        const Texture& map = render(instant, camera, full, level, true);
        SourceMap seen;
        seen.picture = map.download();
        for (const InstantRig& rig : instant.rigs) overlay_.name_rigs({rig.camera().name});
        seen.shares = source_shares(last_eye_->download(), *renderer_->origins());
        seen.legend = overlay_.legend();
        *sources = std::move(seen);
        renderer_->note_origins(false);
    }
    return picture;
}

void mark_unseen(ColourImage& picture) {
    if (picture.empty()) return;
    const int cell_px = std::max(1, picture.cols / cells_a_row);
    const cv::Mat1f distances = distances_to_seen(picture, cell_px);
    double farthest = 0;
    cv::minMaxLoc(distances, nullptr, &farthest);
    if (farthest <= first_cells) return;
    cv::Mat1f shares = (distances - first_cells) / (last_cells - first_cells);
    cv::resize(shares, shares, {}, cell_px, cell_px, cv::INTER_LINEAR);
    const int stripe_px = std::max(2, picture.cols / stripes_a_row);
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            cv::Vec4b& pixel = picture(y, x);
            const float share = std::min(1.0f, shares(y, x));
            if (share <= 0 || !is_unseen(pixel)) continue;
            const cv::Vec3f& mark = (x + y) / stripe_px % 2 == 0 ? dark : light;
            for (int i = 0; i < 3; ++i)
                pixel[i] =
                    cv::saturate_cast<unsigned char>((1 - share) * pixel[i] + share * mark[i]);
        }
}

}  // namespace vantage
