// SPDX-License-Identifier: Apache-2.0
// Private to this folder.
#pragma once

namespace render_node {

/// Returns memory that a software renderer keeps after compiling shaders to the operating system.
///
/// The memory consists of free pages of the heap and of the pages of LLVM's code, some 50 MB. The pages of code come
/// back from the page cache if a shader must be compiled later. Works on Linux only. Leaves the code in memory if LLVM
/// is not a shared library. Takes milliseconds.
void giveBackCompilerMemory();

}  // namespace render_node
