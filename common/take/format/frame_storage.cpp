#include "common/take/format/frame_storage.h"

#include "common/base/error.h"

namespace vantage {
namespace {

TakePictures::Codec codec_of(FrameHead::Colour colour) {
    switch (colour) {
        case FrameHead::Colour::none:
            break;
        case FrameHead::Colour::jpeg:
            return TakePictures::Codec::jpeg;
        case FrameHead::Colour::lossless:
            return TakePictures::Codec::ffv1;
    }
    return TakePictures::Codec::none;
}

cv::Size colour_px(const FrameHead& head) {
    return head.colour == FrameHead::Colour::none
               ? cv::Size()
               : cv::Size(head.frame.geometry.width_px, head.frame.geometry.height_px);
}

std::string size_text(cv::Size size) {
    return size.empty() ? std::string("none") : fmt::format("{}x{}", size.width, size.height);
}

bool is_ffv1(const TakePictures& pictures) { return pictures.codec == TakePictures::Codec::ffv1; }

}  // namespace

TakeRig take_rig_of(const FrameHead& head) {
    if (head.frame.content == RigFrame::Content::raw_pair)
        fail("rig {} sends raw pairs, but a take holds views", head.frame.rig);
    TakeRig rig;
    rig.name = head.frame.rig;
    rig.colour = {codec_of(head.colour), colour_px(head), {}};
    if (is_ffv1(rig.colour))
        rig.colour.setup = LosslessPictureEncoder(rig.colour.size_px, CV_8UC4).setup();
    if (!head.disparity_px.empty())
        rig.depth = {TakePictures::Codec::ffv1, head.disparity_px,
                     LosslessPictureEncoder(head.disparity_px, CV_16UC1).setup()};
    return rig;
}

FrameStorer::FrameStorer(const TakeRig& rig) : rig_(rig) {
    if (is_ffv1(rig_.colour)) colour_.emplace(rig_.colour.size_px, CV_8UC4);
    if (is_ffv1(rig_.depth)) depth_.emplace(rig_.depth.size_px, CV_16UC1);
}

StoredFrame FrameStorer::store(const PackedFrame& frame) {
    const FrameHead head = decode_frame_head(frame.header);
    if (head.frame.content == RigFrame::Content::raw_pair)
        fail("rig {} sends raw pairs, but a take holds views", rig_.name);
    if (codec_of(head.colour) != rig_.colour.codec || colour_px(head) != rig_.colour.size_px ||
        head.disparity_px != rig_.depth.size_px)
        fail(
            "rig {} sends images of {} and disparities of {}, but the take's tracks have {} "
            "and {}; begin another take",
            rig_.name, size_text(colour_px(head)), size_text(head.disparity_px),
            size_text(rig_.colour.size_px), size_text(rig_.depth.size_px));
    StoredFrame stored;
    stored.record.pulse = head.frame.trigger_index;
    stored.record.is_synchronized = head.frame.synchronized;
    stored.record.session = head.frame.session;
    stored.record.exposure = head.frame.exposure;
    stored.record.rig = head.frame.counters;
    stored.record.header = frame.header;
    stored.colour = frame.colour;
    if (colour_)
        stored.colour = colour_->encode(lossless_colour_.decode(
            frame.colour, rig_.colour.size_px.width, rig_.colour.size_px.height));
    if (depth_)
        stored.depth = depth_->encode(disparity_.decode(frame.disparity, rig_.depth.size_px.width,
                                                        rig_.depth.size_px.height));
    return stored;
}

FrameRestorer::FrameRestorer(const TakeRig& rig) : rig_(rig) {
    if (is_ffv1(rig_.colour)) colour_.emplace(rig_.colour.size_px, CV_8UC4, rig_.colour.setup);
    if (is_ffv1(rig_.depth)) depth_.emplace(rig_.depth.size_px, CV_16UC1, rig_.depth.setup);
}

RigFrame FrameRestorer::restore(const StoredFrame& stored, FrameMemory memory) {
    FrameHead head = decode_frame_head(stored.record.header);
    RigFrame& frame = head.frame;
    if (frame.rig != rig_.name)
        fail("a frame of rig {} is in a track of rig {}", frame.rig, rig_.name);
    const bool has_colour = head.colour != FrameHead::Colour::none;
    const bool has_depth = !head.disparity_px.empty();
    if (has_colour == stored.colour.empty() || has_depth == stored.depth.empty() ||
        (has_colour && codec_of(head.colour) != rig_.colour.codec) ||
        (has_colour && colour_px(head) != rig_.colour.size_px) ||
        (has_depth && head.disparity_px != rig_.depth.size_px))
        fail("a frame of rig {} does not fit its tracks", rig_.name);
    if (has_colour && colour_) {
        frame.colour = ColourImage(colour_->decode(stored.colour, std::move(memory.colour)));
    } else if (has_colour) {
        const ColourParts parts = colour_parts(head, stored.colour);
        frame.colour = jpeg_.decode(parts.left, rig_.colour.size_px.width,
                                    rig_.colour.size_px.height, std::move(memory.colour));
        frame.right_jpeg = shared(parts.right);
    }
    if (has_depth) {
        if (!depth_) fail("a frame of rig {} has a disparity that is not FFV1", rig_.name);
        frame.disparity = depth_->decode(stored.depth, std::move(memory.disparity));
    }
    return std::move(frame);
}

}  // namespace vantage
