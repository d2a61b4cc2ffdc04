// What the steps of `fused` do to one moment of the virtual stage, with depth of a rig's own
// matching: writes the strip of docs/develop/synthesis.md.
//   synthesis_steps docs/pictures/synthesis_steps.jpg
#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/image/colour_map.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/gallery/foreground_preparer.h"
#include "host_app/synthesis/source_map.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/bench/support/picture_sheet.h"
#include "tests/bench/support/strip_program.h"
#include "tests/bench/synthesis/matching_rig.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr auto moment = 10s;
/// Instants from which the background is learnt.
constexpr auto between_instants = 500ms;
constexpr int instants = 16;
constexpr double apart_deg = 20;
const cv::Size picture_size(320, 240);
constexpr int columns = 4;
/// Of the rigs from the left to the right, the one whose pictures are shown.
constexpr std::size_t shown_rig = 1;
/// Inverse depths that the colours span, 1/m.
constexpr float far_per_m = 0.12F, near_per_m = 0.5F;

/// `depth_m`: metres in the first channel, guessed ones negative.
ColourImage depth_picture(const cv::Mat& depth_m) {
    cv::Mat1f depth, per_m;
    cv::extractChannel(depth_m, depth, 0);
    cv::divide(1.0, cv::abs(depth), per_m);
    per_m.setTo(0, depth == 0);
    return colour_map_disparity(per_m, far_per_m, near_per_m);
}

/// Performers as they stand before the background.
cv::Mat1f depth_of(const InstantRig& rig) {
    cv::Mat1f depth_m, performers;
    cv::extractChannel(rig.surface->depth().download(), depth_m, 0);
    if (!rig.boundary) return depth_m;
    cv::extractChannel(rig.boundary->depth().download(), performers, 0);
    performers.copyTo(depth_m, performers > 0);
    return depth_m;
}

ColourImage grey_picture(const cv::Mat& share) {
    cv::Mat colour;
    cv::cvtColor(share, colour, cv::COLOR_GRAY2RGBA);
    return colour;
}

/// A learnt colour tells in alpha how far it is trusted.
ColourImage opaque(cv::Mat4b colour) {
    for (cv::Vec4b& pixel : colour) pixel[3] = 255;
    return colour;
}

ColourImage without_inpainted(const ColourImage& picture) {
    ColourImage seen = picture.clone();
    seen.setTo(cv::Scalar(0, 0, 0, 255), ~covered_mask(picture));
    return seen;
}

ColourImage steps() {
    const EglContext context;
    const ShaderLibrary library;
    VirtualStage stage(library);
    std::vector<std::unique_ptr<MatchingRig>> rigs;
    for (const double place : {-1.5, -0.5, 0.5, 1.5})
        rigs.push_back(std::make_unique<MatchingRig>(library, place * apart_deg, rigs.size() + 1,
                                                     MatchingRig::Settings{.size = picture_size}));
    const VirtualView target = camera_of(rig_at(0, picture_size));
    const SynthesiserEntry entry = find_synthesiser(default_synthesiser);
    const auto preparer = entry.make_preparer(library);
    const auto renderer = entry.make_renderer(library);
    ForegroundPreparer apart(library);
    renderer->note_origins(true);

    std::vector<DepthView> views;
    for (int i = 0; i < instants; ++i) {
        views.clear();
        for (const auto& rig : rigs) {
            rig->film(stage, moment - (instants - 1 - i) * between_instants,
                      static_cast<std::uint64_t>(i));
            views.push_back(rig->view(true));
        }
        const double dt_s = std::chrono::duration<double>(between_instants).count();
        preparer->take(views, dt_s);
        apart.take(views, dt_s);
        preparer->prepare(target, prepare_levels().front());
        preparer->improve(target);
    }
    const auto instant = preparer->prepare(target, prepare_levels().front());
    const Texture& picture = renderer->render(*instant, target, render_levels().front());
    const ColourImage rendered = picture.download();
    SourceMapOverlay overlay(library);
    const ColourImage origins = overlay.lay(picture, *renderer->origins()).download();
    const auto told = apart.prepare(target, prepare_levels().front());
    const auto& performers =
        dynamic_cast<const ForegroundInstant&>(*told->extra).rigs.at(shown_rig);

    // An instant's rigs come by their use for the view.
    const InstantRig& rig = *std::find_if(
        instant->rigs.begin(), instant->rigs.end(),
        [&](const InstantRig& one) { return one.camera().name == views[shown_rig].name; });

    PictureSheet sheet(picture_size, columns);
    sheet.add("a rig's picture", views[shown_rig].colour);
    sheet.add("its own depth", depth_picture(views[shown_rig].depth_m));
    sheet.add("1: matte", grey_picture(performers.matte->share.texture().download()));
    sheet.add("1: the background behind", opaque(performers.background->colour().download()));
    sheet.add("2-5: depth, refined", depth_picture(depth_of(rig)));
    sheet.add("6, 7: which rig shows what", origins);
    sheet.add("7-9: what rigs see", without_inpainted(rendered));
    sheet.add("10-12: the picture", rendered);
    return sheet.picture();
}

}  // namespace
}  // namespace vantage

int main(int argc, char** argv) {
    return vantage::run_strip_program("synthesis_steps",
                                      "What the steps of the synthesis do to one moment", argc,
                                      argv, vantage::steps);
}
