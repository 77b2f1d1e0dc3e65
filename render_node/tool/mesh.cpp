// SPDX-License-Identifier: Apache-2.0
#include "render_node/tool/mesh.hpp"

namespace render_node {

void ToolMesh::show(const sand::Tool& tool) {
    const shapes::ToolForm now = shapes::formOf(tool);
    if (shown_ != now) {
        mesh_.set(shapes::makeTool(tool));
        shown_ = now;
    }
}

}  // namespace render_node
