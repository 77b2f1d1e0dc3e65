// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

namespace render_node {

/// Hands back what compiling shaders has left behind in a software renderer: the heap's free pages, and the pages of
/// LLVM's code, some 50 MB, which come back from the page cache if a shader must be compiled after all.
///
/// Linux only; does nothing where the driver brings no LLVM of its own library. Milliseconds.
void giveBackCompilerMemory();

}  // namespace render_node
