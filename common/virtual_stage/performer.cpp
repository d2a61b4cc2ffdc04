#include "common/virtual_stage/performer.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "common/virtual_stage/tau.h"

namespace vantage {
namespace {

using Eigen::Affine3f;
using Eigen::AngleAxisf;
using Eigen::Vector3f;

// A figure of 1.75 m: y up, facing +z, its left is +x. Bones hang from the joints along -y, the
// trunk rises along +y. Other heights are scaled.
constexpr float model_height_m = 1.75f;
constexpr float hip_half_width_m = 0.095f, shoulder_half_width_m = 0.185f;
constexpr float waist_height_m = 0.12f, shoulder_height_m = 0.36f, neck_height_m = 0.45f;
constexpr float upper_arm_m = 0.29f, thigh_m = 0.43f, shin_m = 0.43f, sole_m = 0.075f;

enum Bone {
    pelvis,
    chest,
    head,
    upper_arm_left,
    forearm_left,
    upper_arm_right,
    forearm_right,
    thigh_left,
    shin_left,
    thigh_right,
    shin_right
};

/// Angles in radians. Pitch swings a limb forward, roll swings it out to its side.
struct Limb {
    float pitch = 0, roll = 0, bend = 0;
};
struct FigurePose {
    Eigen::Vector2f place_m = Eigen::Vector2f::Zero();
    float heading = 0;
    float hip_roll = 0, lean = 0, twist = 0, sway = 0, head_yaw = 0, head_pitch = 0;
    Limb left_arm, right_arm, left_leg, right_leg;
};

/// An angle that is kept in double precision until its sine is taken: every one turns a whole
/// number of times in a loop, so that motion has no seam.
using Turns = double;
float sine(Turns turns) { return static_cast<float>(std::sin(2 * std::numbers::pi * turns)); }
float cosine(Turns turns) { return static_cast<float>(std::cos(2 * std::numbers::pi * turns)); }

/// The way that is walked, and legs whose strides are as long as it, so that feet do not slide.
FigurePose walk(const PerformerStyle& style, double share) {
    const double way_m = style.speed_m_per_s() * std::chrono::duration<double>(stage_loop).count();
    // People take longer strides when they walk faster.
    const double usual_stride_m = 0.75 + 0.45 * style.speed_m_per_s();
    const double strides = std::max(1.0, std::round(way_m / usual_stride_m));
    const auto stride_of_model_m =
        static_cast<float>(way_m / strides) * model_height_m / style.height_m;
    const Turns around = style.laps * share + style.phase, gait = strides * share + style.phase;
    FigurePose pose;
    pose.place_m = style.walk_radius_m * Eigen::Vector2f(sine(around), cosine(around));
    const Turns ahead = around - std::floor(around) + (style.laps < 0 ? -0.25 : 0.25);
    pose.heading = tau * static_cast<float>(ahead);
    const float swing = 0.31f * stride_of_model_m;
    const auto leg = [&](Turns phase) {
        Limb limb;
        const float lifted = std::max(0.0f, cosine(phase));
        limb.bend = 0.12f + 0.85f * lifted * lifted;
        limb.pitch = swing * sine(phase) + 0.35f * limb.bend;
        return limb;
    };
    pose.left_leg = leg(gait);
    pose.right_leg = leg(gait + 0.5);
    pose.left_arm = {-1.1f * swing * sine(gait), 0.10f, 0.35f - 0.2f * sine(gait)};
    pose.right_arm = {1.1f * swing * sine(gait), 0.10f, 0.35f + 0.2f * sine(gait)};
    pose.twist = 0.10f * sine(gait);
    pose.hip_roll = 0.03f * cosine(gait);
    pose.lean = 0.05f;
    pose.head_yaw = 0.5f * sine(2 * share);
    return pose;
}

FigurePose dance(const PerformerStyle& style, double share) {
    const Turns beat = style.beats * share + style.phase;
    FigurePose pose = walk(style, share);
    pose.heading += 0.35f * sine(0.125 * beat);
    pose.sway = 0.14f * sine(0.5 * beat);
    pose.hip_roll = -0.12f * sine(0.5 * beat);
    pose.twist = 0.30f * sine(0.25 * beat + 0.1);
    pose.lean = 0.06f + 0.04f * sine(beat);
    const float raise = 0.5f + 0.5f * sine(0.125 * beat);
    pose.left_arm = {0.5f * sine(0.5 * beat), 0.5f + 1.7f * raise, 0.6f + 0.4f * sine(beat)};
    pose.right_arm = {0.5f * sine(0.5 * beat + 0.32), 0.5f + 1.5f * (1 - raise),
                      0.8f + 0.4f * cosine(beat)};
    const float dip = 0.12f + 0.10f * cosine(beat);
    for (Limb* leg : {&pose.left_leg, &pose.right_leg}) {
        leg->pitch += dip;
        leg->bend += 2 * dip;
        leg->roll = 0.08f;
    }
    pose.head_yaw = 0.35f * sine(0.25 * beat);
    pose.head_pitch = 0.12f * sine(beat);
    return pose;
}

FigurePose sing(const PerformerStyle& style, double share) {
    const Turns beat = style.beats * share + style.phase;
    FigurePose pose = walk(style, share);
    pose.sway = 0.05f * sine(0.5 * beat);
    pose.hip_roll = -0.05f * sine(0.5 * beat);
    pose.twist = 0.12f * sine(0.5 * beat);
    pose.right_arm = {0.75f, 0.10f, 1.75f};  // a hand at the mouth, as with a microphone
    pose.left_arm = {0.35f + 0.4f * sine(0.5 * beat), 0.45f + 0.35f * sine(0.25 * beat),
                     0.9f + 0.5f * sine(0.5 * beat + 0.16)};
    pose.head_pitch = 0.08f * sine(beat) - 0.05f;
    pose.head_yaw = 0.15f * sine(0.375 * beat);
    return pose;
}

Affine3f joint(const Vector3f& at) { return Affine3f(Eigen::Translation3f(at)); }
AngleAxisf about_x(float angle) { return {angle, Vector3f::UnitX()}; }
AngleAxisf about_y(float angle) { return {angle, Vector3f::UnitY()}; }
AngleAxisf about_z(float angle) { return {angle, Vector3f::UnitZ()}; }

}  // namespace

double loop_share(std::chrono::nanoseconds stage_time) {
    constexpr std::chrono::nanoseconds loop = stage_loop;
    const std::chrono::nanoseconds into = (stage_time % loop + loop) % loop;
    return static_cast<double>(into.count()) / static_cast<double>(loop.count());
}

double PerformerStyle::speed_m_per_s() const {
    return 2 * std::numbers::pi * static_cast<double>(walk_radius_m) * std::abs(laps) /
           std::chrono::duration<double>(stage_loop).count();
}

float PerformerStyle::reach_m() const {
    // Of the model, over a loop: arms hang, a bent one stands out a little, or both are spread.
    const float model_reach_m = move == PerformerMove::walk   ? 0.42f
                                : move == PerformerMove::sing ? 0.65f
                                                              : 0.95f;
    return model_reach_m * height_m / model_height_m;
}

void pose_performer(const PerformerStyle& style, std::chrono::nanoseconds stage_time,
                    std::span<Affine3f> world_from_bone) {
    assert(world_from_bone.size() == bones_of_performer);
    const double share = loop_share(stage_time);
    const FigurePose pose = style.move == PerformerMove::walk    ? walk(style, share)
                            : style.move == PerformerMove::dance ? dance(style, share)
                                                                 : sing(style, share);
    const auto bones = world_from_bone;
    bones[pelvis] = about_y(pose.heading) * about_z(pose.hip_roll);
    bones[chest] = bones[pelvis] * joint({0, waist_height_m, 0}) * about_y(pose.twist) *
                   about_x(pose.lean) * about_z(pose.sway - pose.hip_roll);
    bones[head] = bones[chest] * joint({0, neck_height_m, 0}) * about_y(pose.head_yaw) *
                  about_x(pose.head_pitch);
    const auto hang = [&](Bone upper, Bone parent, const Vector3f& at, const Limb& limb, float side,
                          float length_m, float bend_sign) {
        bones[upper] = bones[parent] * joint(at) * about_z(side * limb.roll) * about_x(-limb.pitch);
        bones[static_cast<std::size_t>(upper) + 1] =
            bones[upper] * joint({0, -length_m, 0}) * about_x(bend_sign * limb.bend);
    };
    hang(upper_arm_left, chest, {shoulder_half_width_m, shoulder_height_m, 0}, pose.left_arm, 1,
         upper_arm_m, -1);
    hang(upper_arm_right, chest, {-shoulder_half_width_m, shoulder_height_m, 0}, pose.right_arm, -1,
         upper_arm_m, -1);
    hang(thigh_left, pelvis, {hip_half_width_m, 0, 0}, pose.left_leg, 1, thigh_m, 1);
    hang(thigh_right, pelvis, {-hip_half_width_m, 0, 0}, pose.right_leg, -1, thigh_m, 1);
    // The lower foot stands on the floor; everything rises with it.
    const auto sole = [&](Bone shin) {
        return (bones[shin] * Vector3f(0, -shin_m - sole_m, 0.03f)).y();
    };
    const float floor = std::min(sole(shin_left), sole(shin_right));
    const float scale = style.height_m / model_height_m;
    const Affine3f placement =
        Eigen::Translation3f(pose.place_m.x(), -floor * scale, pose.place_m.y()) *
        Eigen::Scaling(scale);
    for (Affine3f& bone : bones) bone = placement * bone;
}

void add_performer(StageMeshBuilder& builder, const PerformerStyle& style, int first_bone) {
    const auto on = [&](Bone bone, const StageMaterial& material) {
        builder.set_bone(first_bone + bone);
        builder.set_material(material);
    };
    StageMaterial eyes = style.skin;
    eyes.tint = {0.12f, 0.10f, 0.10f};

    on(pelvis, style.bottom);
    if (style.skirt) {
        builder.loft(std::array<LoftRing, 8>{{{0.13f, 0.0f, 0.0f},
                                              {0.13f, 0.120f, 0.095f},
                                              {0.05f, 0.165f, 0.140f},
                                              {-0.06f, 0.215f, 0.215f, 0.02f},
                                              {-0.20f, 0.270f, 0.290f, 0.03f},
                                              {-0.34f, 0.320f, 0.350f, 0.03f},
                                              {-0.36f, 0.315f, 0.345f, 0.03f},
                                              {-0.26f, 0.0f, 0.0f}}},
                     18);
    } else {
        builder.loft(std::array<LoftRing, 8>{{{0.14f, 0.0f, 0.0f},
                                              {0.14f, 0.125f, 0.09f},
                                              {0.06f, 0.150f, 0.112f, -0.005f},
                                              {0.0f, 0.168f, 0.120f, -0.012f},
                                              {-0.05f, 0.165f, 0.118f, -0.010f},
                                              {-0.09f, 0.140f, 0.105f},
                                              {-0.12f, 0.085f, 0.08f},
                                              {-0.13f, 0.0f, 0.0f}}},
                     14);
    }

    on(chest, style.top);
    builder.loft(std::array<LoftRing, 12>{{{-0.03f, 0.0f, 0.0f},
                                           {-0.03f, 0.142f, 0.105f},
                                           {0.03f, 0.132f, 0.098f},
                                           {0.10f, 0.142f, 0.105f},
                                           {0.19f, 0.165f, 0.118f, 0.008f},
                                           {0.27f, 0.178f, 0.118f, 0.008f},
                                           {0.33f, 0.180f, 0.105f},
                                           {0.375f, 0.155f, 0.088f, -0.005f},
                                           {0.40f, 0.105f, 0.072f, -0.008f},
                                           {0.415f, 0.065f, 0.062f, -0.008f},
                                           {0.43f, 0.058f, 0.058f, -0.005f},
                                           {0.435f, 0.0f, 0.0f}}},
                 16);
    on(chest, style.skin);
    builder.rod({0, 0.41f, -0.005f}, {0, 0.49f, 0.008f}, 0.05f, 0.046f, 12, false);

    on(head, style.skin);
    builder.loft(std::array<LoftRing, 12>{{{0.0f, 0.0f, 0.0f, 0.02f},
                                           {0.005f, 0.030f, 0.032f, 0.045f},
                                           {0.025f, 0.048f, 0.060f, 0.032f},
                                           {0.055f, 0.062f, 0.080f, 0.018f},
                                           {0.09f, 0.070f, 0.092f, 0.008f},
                                           {0.125f, 0.075f, 0.097f, 0.004f},
                                           {0.16f, 0.076f, 0.098f, 0.0f},
                                           {0.19f, 0.072f, 0.094f, -0.002f},
                                           {0.215f, 0.060f, 0.082f, -0.004f},
                                           {0.235f, 0.040f, 0.060f, -0.006f},
                                           {0.245f, 0.020f, 0.032f, -0.008f},
                                           {0.248f, 0.0f, 0.0f, -0.008f}}},
                 14);
    builder.ellipsoid({0, 0.098f, 0.104f}, {0.013f, 0.024f, 0.018f}, 6, 4);  // nose
    builder.ellipsoid({0.078f, 0.115f, 0.0f}, {0.012f, 0.030f, 0.018f}, 6, 4);
    builder.ellipsoid({-0.078f, 0.115f, 0.0f}, {0.012f, 0.030f, 0.018f}, 6, 4);
    on(head, eyes);
    for (const float side : {-1.0f, 1.0f}) {
        builder.ellipsoid({side * 0.030f, 0.130f, 0.089f}, {0.013f, 0.008f, 0.010f}, 6, 4);
        builder.ellipsoid({side * 0.030f, 0.150f, 0.089f}, {0.018f, 0.004f, 0.010f}, 6, 3);
    }
    StageMaterial lips = style.skin;
    lips.tint = {0.70f, 0.32f, 0.30f};
    on(head, lips);
    builder.ellipsoid({0, 0.055f, 0.092f}, {0.022f, 0.007f, 0.010f}, 6, 4);
    on(head, style.hair);
    builder.ellipsoid({0, 0.168f, -0.014f}, {0.086f, 0.092f, 0.106f}, 14, 8);
    if (style.long_hair) {
        builder.loft(std::array<LoftRing, 7>{{{0.18f, 0.060f, 0.040f, -0.070f},
                                              {0.10f, 0.085f, 0.045f, -0.075f},
                                              {0.02f, 0.088f, 0.045f, -0.080f},
                                              {-0.06f, 0.092f, 0.042f, -0.085f},
                                              {-0.14f, 0.084f, 0.036f, -0.085f},
                                              {-0.20f, 0.055f, 0.026f, -0.080f},
                                              {-0.23f, 0.0f, 0.0f, -0.078f}}},
                     10);
    }

    for (const Bone upper : {upper_arm_left, upper_arm_right}) {
        on(upper, style.top);
        builder.loft(std::array<LoftRing, 7>{{{0.055f, 0.0f, 0.0f},
                                              {0.045f, 0.036f, 0.040f},
                                              {0.015f, 0.058f, 0.060f},
                                              {-0.05f, 0.058f, 0.060f},
                                              {-0.15f, 0.050f, 0.052f},
                                              {-0.27f, 0.043f, 0.044f},
                                              {-0.30f, 0.0f, 0.0f}}},
                     10);
        const auto lower = static_cast<Bone>(upper + 1);
        on(lower, style.top);
        builder.loft(std::array<LoftRing, 6>{{{0.035f, 0.0f, 0.0f},
                                              {0.022f, 0.036f, 0.036f},
                                              {-0.02f, 0.045f, 0.045f},
                                              {-0.10f, 0.042f, 0.042f},
                                              {-0.19f, 0.036f, 0.036f},
                                              {-0.19f, 0.0f, 0.0f}}},
                     10);
        on(lower, style.skin);
        builder.loft(std::array<LoftRing, 8>{{{-0.17f, 0.026f, 0.028f},
                                              {-0.23f, 0.022f, 0.026f},
                                              {-0.255f, 0.020f, 0.034f, 0.002f},
                                              {-0.29f, 0.019f, 0.042f, 0.004f},
                                              {-0.33f, 0.018f, 0.042f, 0.004f},
                                              {-0.37f, 0.016f, 0.036f, 0.002f},
                                              {-0.405f, 0.012f, 0.024f},
                                              {-0.42f, 0.0f, 0.0f}}},
                     8);
        builder.rod({0, -0.26f, 0.03f}, {0, -0.325f, 0.062f}, 0.014f, 0.010f, 8);  // thumb
    }

    const StageMaterial& leg = style.skirt ? style.skin : style.bottom;
    for (const Bone upper : {thigh_left, thigh_right}) {
        on(upper, leg);
        builder.loft(std::array<LoftRing, 7>{{{0.06f, 0.0f, 0.0f},
                                              {0.04f, 0.070f, 0.080f},
                                              {-0.02f, 0.085f, 0.095f, -0.004f},
                                              {-0.15f, 0.080f, 0.088f},
                                              {-0.30f, 0.066f, 0.070f},
                                              {-0.42f, 0.058f, 0.060f, 0.004f},
                                              {-0.48f, 0.0f, 0.0f}}},
                     12);
        const auto lower = static_cast<Bone>(upper + 1);
        on(lower, leg);
        builder.loft(std::array<LoftRing, 8>{{{0.05f, 0.0f, 0.0f},
                                              {0.03f, 0.045f, 0.046f, 0.004f},
                                              {-0.03f, 0.056f, 0.058f, 0.002f},
                                              {-0.12f, 0.054f, 0.060f, -0.012f},
                                              {-0.25f, 0.046f, 0.049f, -0.008f},
                                              {-0.38f, 0.043f, 0.046f},
                                              {-0.43f, 0.046f, 0.052f, 0.004f},
                                              {-0.43f, 0.0f, 0.0f}}},
                     10);
        on(lower, style.shoes);
        builder.loft(std::array<LoftRing, 5>{{{-0.40f, 0.036f, 0.040f, -0.004f},
                                              {-0.45f, 0.044f, 0.075f, 0.028f},
                                              {-0.478f, 0.050f, 0.125f, 0.056f},
                                              {-0.503f, 0.050f, 0.130f, 0.058f},
                                              {-0.505f, 0.0f, 0.0f, 0.05f}}},
                     10);
    }
}

}  // namespace vantage
