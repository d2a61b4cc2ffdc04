#pragma once

#include <span>
#include <string>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {

/// Tests that compare what synthesisers make of views.
class GalleryRendering : public testing::Test {
  protected:
    /// `name` with its options.
    ColourImage render(const std::string& name, std::span<const DepthView> views,
                       const VirtualView& target) {
        Synthesiser synthesiser(find_synthesiser(name), shaders_);
        synthesiser.set_views(views);
        return synthesiser.render(target).download();
    }

    EglContext context_;
    ShaderLibrary shaders_;
};

}  // namespace vantage
