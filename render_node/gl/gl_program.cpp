// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/gl_program.hpp"

#include <array>
#include <stdexcept>

#include "render_node/gl/compiler_memory.hpp"

namespace render_node {
namespace {

std::string firstLine(const std::string& text) {
    const auto start = text.find_first_not_of(" \n\r\t");
    if (start == std::string::npos) {
        return "the driver gave no reason";
    }
    return text.substr(start, text.find_first_of("\r\n", start) - start);
}

class Shader {
public:
    Shader(GLenum kind, const std::vector<const ShaderSource*>& parts) : id_(glCreateShader(kind)) {
        std::string text = "#version 330 core\n";
        for (const ShaderSource* part : parts) {
            text += "#line 1\n" + part->text + "\n";
        }
        const char* start = text.c_str();
        glShaderSource(id_, 1, &start, nullptr);
        glCompileShader(id_);
        GLint fine = GL_FALSE;
        glGetShaderiv(id_, GL_COMPILE_STATUS, &fine);
        if (fine != GL_TRUE) {
            std::array<char, 1024> log{};
            glGetShaderInfoLog(id_, static_cast<GLsizei>(log.size()), nullptr, log.data());
            glDeleteShader(id_);
            throw std::runtime_error("render_node/shaders/" + parts.back()->file +
                                     ": the OpenGL driver does not compile it: " + firstLine(log.data()));
        }
    }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    ~Shader() { glDeleteShader(id_); }
    [[nodiscard]] GLuint id() const { return id_; }

private:
    GLuint id_;
};

}  // namespace

const ShaderSource& shaderSource(std::string_view file) {
    for (const ShaderSource& source : shaderSources()) {
        if (source.file == file) {
            return source;
        }
    }
    throw std::out_of_range("no embedded shader " + std::string(file));
}

GlProgram::GlProgram(const ShaderSource& vertex, const ShaderSource& light, const ShaderSource& fragment) {
    const Shader first(GL_VERTEX_SHADER, {&light, &vertex});
    const Shader second(GL_FRAGMENT_SHADER, {&light, &fragment});
    for (const Shader* shader : {&first, &second}) {
        glAttachShader(program_.id(), shader->id());
    }
    glLinkProgram(program_.id());
    GLint fine = GL_FALSE;
    glGetProgramiv(program_.id(), GL_LINK_STATUS, &fine);
    if (fine != GL_TRUE) {
        std::array<char, 1024> log{};
        glGetProgramInfoLog(program_.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
        throw std::runtime_error("render_node/shaders/" + fragment.file + ": the OpenGL driver does not link it with " +
                                 vertex.file + ": " + firstLine(log.data()));
    }
}

void GlProgram::drawn() const {
    if (!drawn_) {
        drawn_ = true;
        giveBackCompilerMemory();
    }
}

GlProgram::GlProgram(std::string_view vertexFile, std::string_view fragmentFile)
    : GlProgram(shaderSource(vertexFile), shaderSource("light.glsl"), shaderSource(fragmentFile)) {}

}  // namespace render_node
