#include "common/gl/context/context_group.h"

#include <memory>

#include <GLES3/gl31.h>
#include <gtest/gtest.h>

#include "common/gl/context/context_loss.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/texture.h"
#include "tests/support/gpu_reset.h"

namespace vantage {
namespace {

TEST(ContextGroup, KeepsTheCurrentContext) {
    ContextGroup group;
    EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
    const ContextGroup::Member member = group.join();
    EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
    EXPECT_EQ(member.generation, group.generation());
    EXPECT_EQ(group.losses(), 0);
}

TEST(ContextGroup, SharesObjectsAmongItsContexts) {
    ContextGroup group;
    const ContextGroup::Member first = group.join(), second = group.join();
    const CurrentContext on_first(*first.context);
    const Texture texture(TextureFormat::r8, 3, 2);
    glFinish();
    const CurrentContext on_second(*second.context);
    EXPECT_TRUE(glIsTexture(texture.name()));
}

TEST(ContextGroup, ReportsAResetAndIsRenewedOnce) {
    ContextGroup group;
    const ContextGroup::Member lost = group.join();
    if (!makes_robust_contexts(lost.context->display()))
        GTEST_SKIP() << "this driver does not tell of resets";
    const CurrentContext on_lost(*lost.context);
    EXPECT_NO_THROW(check_gl("nothing happened"));
    reset_gpu();
    EXPECT_THROW(check_gl("drawing"), ContextLost);
    EXPECT_THROW(require_context("drawing"), ContextLost);
    group.renew(lost.generation);
    group.renew(lost.generation);
    EXPECT_EQ(group.losses(), 1);
    const ContextGroup::Member next = group.join();
    EXPECT_EQ(next.generation, lost.generation + 1);
    const CurrentContext on_next(*next.context);
    EXPECT_NO_THROW(check_gl("all is well again"));
}

/// A name of the lost group may mean another's object by now.
TEST(CurrentContext, NoneAllowsDestructionWithoutAffectingTheCurrentContext) {
    ContextGroup group;
    const ContextGroup::Member member = group.join();
    const CurrentContext current(*member.context);
    auto texture = std::make_unique<Texture>(TextureFormat::r8, 3, 2);
    const GLuint name = texture->name();
    {
        const CurrentContext none{CurrentContext::None{}};
        EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
        texture.reset();
    }
    EXPECT_TRUE(glIsTexture(name));
    glDeleteTextures(1, &name);
}

}  // namespace
}  // namespace vantage
