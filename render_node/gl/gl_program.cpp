// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/gl_program.hpp"

#include <array>
#include <memory>
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
            throw std::runtime_error(parts.back()->path() +
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
    link(std::array{first.id(), second.id()}, vertex, fragment);
}

GlProgram::GlProgram(const ProgramFiles& files) {
    std::vector<const ShaderSource*> parts{&shaderSource("light.glsl"), &shaderSource(files.tool)};
    for (const std::string_view file : {files.sheen, files.look}) {
        if (!file.empty()) {
            parts.push_back(&shaderSource(file));
        }
    }
    const auto compile = [&](GLenum kind, std::string_view file) {
        std::vector<const ShaderSource*> all = parts;
        all.push_back(&shaderSource(file));
        return std::make_unique<Shader>(kind, all);
    };
    std::vector<std::unique_ptr<Shader>> shaders;
    shaders.push_back(compile(GL_VERTEX_SHADER, files.vertex));
    if (!files.geometry.empty()) {
        shaders.push_back(compile(GL_GEOMETRY_SHADER, files.geometry));
    }
    shaders.push_back(compile(GL_FRAGMENT_SHADER, files.fragment));
    std::vector<GLuint> ids;
    ids.reserve(shaders.size());
    for (const auto& shader : shaders) {
        ids.push_back(shader->id());
    }
    link(ids, shaderSource(files.vertex), shaderSource(files.fragment));
}

void GlProgram::link(std::span<const GLuint> shaders, const ShaderSource& vertex, const ShaderSource& fragment) {
    for (const GLuint shader : shaders) {
        glAttachShader(program_.id(), shader);
    }
    glLinkProgram(program_.id());
    GLint fine = GL_FALSE;
    glGetProgramiv(program_.id(), GL_LINK_STATUS, &fine);
    if (fine != GL_TRUE) {
        std::array<char, 1024> log{};
        glGetProgramInfoLog(program_.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
        throw std::runtime_error(fragment.path() + ": the OpenGL driver does not link it with " + vertex.file + ": " +
                                 firstLine(log.data()));
    }
}

void GlProgram::drawn() const {
    if (!drawn_) {
        drawn_ = true;
        giveBackCompilerMemory();
    }
}

}  // namespace render_node
