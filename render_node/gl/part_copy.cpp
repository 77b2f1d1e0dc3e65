// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/part_copy.hpp"

namespace render_node {
namespace {

constexpr int kAccelerated = 0x8186;  // GLX_RENDERER_ACCELERATED_MESA
using QueryRenderer = int (*)(int attribute, unsigned* value);

bool drawsWithTheProcessor(const GlxLoader& loader) {
    if (!loader.supports("GLX_MESA_query_renderer")) {
        return false;
    }
    const auto query = loader.load<QueryRenderer>("glXQueryCurrentRendererIntegerMESA");
    unsigned accelerated = 1;
    return query != nullptr && query(kAccelerated, &accelerated) != 0 && accelerated == 0;
}

}  // namespace

PartCopy::PartCopy(const GlxLoader& loader, GlxDrawable window) : display_(loader.display), window_(window) {
    if (loader.supports("GLX_MESA_copy_sub_buffer") && drawsWithTheProcessor(loader)) {
        copy_ = loader.load<Copy>("glXCopySubBufferMESA");
    }
}

void PartCopy::show(const PixelRect& part) const {
    copy_(display_, window_, part.x0, part.y0, part.x1 - part.x0, part.y1 - part.y0);
}

}  // namespace render_node
