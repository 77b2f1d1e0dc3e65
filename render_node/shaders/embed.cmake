# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT, a C++ file that contains every file of FILES as text. Their paths begin at the folder ROOT.
file(WRITE ${OUTPUT}.new "// Generated from render_node/shaders and shapes/shaders.\n#include \"render_node/gl/gl_program.hpp\"\n\n"
    "namespace render_node {\nconst std::vector<ShaderSource>& shaderSources() {\n"
    "    static const std::vector<ShaderSource> sources{\n")
foreach(path IN LISTS FILES)
    get_filename_component(name ${path} NAME)
    get_filename_component(folder ${path} DIRECTORY)
    file(READ ${ROOT}/${path} text)
    file(APPEND ${OUTPUT}.new "{\"${name}\", R\"glsl(${text})glsl\", \"${folder}\"},\n")
endforeach()
file(APPEND ${OUTPUT}.new "    };\n    return sources;\n}\n}  // namespace render_node\n")
file(RENAME ${OUTPUT}.new ${OUTPUT})
