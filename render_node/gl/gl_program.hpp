// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render_node/gl/gl_handle.hpp"

namespace render_node {

/// Shader file from render_node/shaders, or from shapes/shaders if the web page needs it, too. Embedded at build time.
struct ShaderSource {
    std::string file;  // file name without folder
    std::string text;  // GLSL 3.30 without the #version line
    std::string folder = "render_node/shaders";
    /// Returns the file as messages show it.
    [[nodiscard]] std::string path() const { return folder + "/" + file; }
};

/// Returns all shader files, in the order of CMakeLists.txt.
[[nodiscard]] const std::vector<ShaderSource>& shaderSources();
/// Returns one shader file. Throws std::out_of_range if `file` was not embedded.
[[nodiscard]] const ShaderSource& shaderSource(std::string_view file);

/// Names of the embedded files of a program.
struct ProgramFiles {
    std::string_view vertex, fragment;
    std::string_view look{};      // put before the other files, after light.glsl and the tool's file
    std::string_view geometry{};  // geometry shader; empty: none
    // Put before the other files, after light.glsl: the light that the tool takes away.
    std::string_view tool = "ball.glsl";
    std::string_view sheen{};  // put before `look`: the sheen of wet sand; empty: none
};

/// Linked shaders and their uniforms.
class GlProgram {
public:
    /// Compiles and links the shaders. `light` is put before both. Throws std::runtime_error, with one line
    /// "render_node/shaders/FILE: message" (or "shapes/shaders/FILE: …") that contains the first error of the driver's
    /// compiler.
    GlProgram(const ShaderSource& vertex, const ShaderSource& light, const ShaderSource& fragment);
    /// Compiles and links embedded files. light.glsl is put before all of them. Throws std::runtime_error if a file
    /// does not compile or link.
    explicit GlProgram(const ProgramFiles& files);
    GlProgram(std::string_view vertexFile, std::string_view fragmentFile)
        : GlProgram(ProgramFiles{vertexFile, fragmentFile}) {}

    void use() const { glUseProgram(program_.id()); }
    /// Must be called after draw calls with this program. Software drivers compile at the first draw call. drawn() then
    /// returns the memory of that compilation before the next program is compiled.
    void drawn() const;
    // The program must be in use. As in GL, a name that the shader does not have is ignored.
    void set(const char* name, int value) const { glUniform1i(find(name), value); }
    void set(const char* name, float value) const { glUniform1f(find(name), value); }
    void set(const char* name, const glm::ivec2& value) const { glUniform2iv(find(name), 1, &value[0]); }
    void set(const char* name, const glm::vec2& value) const { glUniform2fv(find(name), 1, &value[0]); }
    void set(const char* name, const glm::vec3& value) const { glUniform3fv(find(name), 1, &value[0]); }
    void set(const char* name, const glm::vec4& value) const { glUniform4fv(find(name), 1, &value[0]); }
    void set(const char* name, const glm::mat3& value) const {
        glUniformMatrix3fv(find(name), 1, GL_FALSE, &value[0][0]);
    }
    void set(const char* name, const glm::mat4& value) const {
        glUniformMatrix4fv(find(name), 1, GL_FALSE, &value[0][0]);
    }
    /// Sets an array, from its first element.
    void set(const char* name, std::span<const GLuint> values) const {
        glUniform1uiv(find(name), static_cast<GLsizei>(values.size()), values.data());
    }

private:
    void link(std::span<const GLuint> shaders, const ShaderSource& vertex, const ShaderSource& fragment);
    [[nodiscard]] GLint find(const char* name) const { return glGetUniformLocation(program_.id(), name); }
    GlHandle<ProgramKind> program_;
    mutable bool drawn_ = false;
};

}  // namespace render_node
