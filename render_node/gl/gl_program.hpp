// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render_node/gl/gl_handle.hpp"

namespace render_node {

/// One file of render_node/shaders, embedded at build time.
struct ShaderSource {
    std::string file;  // its name without folder, as messages show it
    std::string text;  // GLSL 3.30 without the #version line
};

/// All of them, in the order of CMakeLists.txt.
[[nodiscard]] const std::vector<ShaderSource>& shaderSources();
/// Throws std::out_of_range for a file that was not embedded.
[[nodiscard]] const ShaderSource& shaderSource(std::string_view file);

/// Names of embedded files that make a program.
struct ProgramFiles {
    std::string_view vertex, fragment;
    std::string_view look{};              // put before both, behind light.glsl and the tool's
    std::string_view geometry{};          // between them
    std::string_view tool = "ball.glsl";  // put before both, behind light.glsl: the light that the tool takes
};

/// Linked shaders and their uniforms.
class GlProgram {
public:
    /// `light` is put before both. Throws std::runtime_error, one line "render_node/shaders/FILE: message", with
    /// the first complaint of the driver's compiler.
    GlProgram(const ShaderSource& vertex, const ShaderSource& light, const ShaderSource& fragment);
    /// From embedded files; light.glsl is put before all. Throws as above.
    explicit GlProgram(const ProgramFiles& files);
    GlProgram(std::string_view vertexFile, std::string_view fragmentFile)
        : GlProgram(ProgramFiles{vertexFile, fragmentFile}) {}

    void use() const { glUseProgram(program_.id()); }
    /// To be said behind draw calls with it: software drivers compile at the first, and what that took is given back
    /// before the next program's is added to it.
    void drawn() const;
    // The program must be in use. A name that the shader does not have is ignored, as GL does.
    void set(const char* name, int value) const { glUniform1i(find(name), value); }
    void set(const char* name, float value) const { glUniform1f(find(name), value); }
    void set(const char* name, const glm::vec2& value) const { glUniform2fv(find(name), 1, &value[0]); }
    void set(const char* name, const glm::vec3& value) const { glUniform3fv(find(name), 1, &value[0]); }
    void set(const char* name, const glm::vec4& value) const { glUniform4fv(find(name), 1, &value[0]); }
    void set(const char* name, const glm::mat3& value) const {
        glUniformMatrix3fv(find(name), 1, GL_FALSE, &value[0][0]);
    }
    void set(const char* name, const glm::mat4& value) const {
        glUniformMatrix4fv(find(name), 1, GL_FALSE, &value[0][0]);
    }
    /// An array from its first element on.
    void set(const char* name, std::span<const GLuint> values) const {
        glUniform1uiv(find(name), static_cast<GLsizei>(values.size()), values.data());
    }

private:
    void link(std::span<const GLuint> shaders, const std::string& vertex, const std::string& fragment);
    [[nodiscard]] GLint find(const char* name) const { return glGetUniformLocation(program_.id(), name); }
    GlHandle<ProgramKind> program_;
    mutable bool drawn_ = false;
};

}  // namespace render_node
