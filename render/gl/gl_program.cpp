#include "render/gl/gl_program.h"

#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "render/gl/embedded.h"

namespace neve::render::gl {
namespace {

/// Deletes the shader when the program is linked or building fails.
struct Shader {
  const Gl& gl;
  GLuint id;
  Shader(const Gl& table, GLenum stage) : gl(table), id(table.CreateShader(stage)) {}
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  ~Shader() { gl.DeleteShader(id); }

  void compile(const std::string& file_name, const std::string& source) const {
    const char* text = source.c_str();
    gl.ShaderSource(id, 1, &text, nullptr);
    gl.CompileShader(id);
    GLint is_compiled = 0;
    gl.GetShaderiv(id, GL_COMPILE_STATUS, &is_compiled);
    if (is_compiled) return;
    char log[4096] = "";
    gl.GetShaderInfoLog(id, sizeof log, nullptr, log);
    throw std::runtime_error("shaders/" + file_name + " does not compile:\n" + log);
  }
};

}  // namespace

std::string ShaderLibrary::read(const std::string& file_name) const {
  if (!folder_.empty()) {
    std::ifstream file(folder_ + "/" + file_name, std::ios::binary);
    if (!file) throw std::runtime_error("shader not found: " + folder_ + "/" + file_name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  const std::string_view text = find_embedded_shader(file_name);
  if (text.empty()) throw std::runtime_error("shader not in the binary: " + file_name);
  return std::string(text);
}

std::string ShaderLibrary::source(const std::string& file_name, const std::string& defines) const {
  std::string out = "#version 330 core\n" + defines + "#line 1\n";
  std::istringstream lines(read(file_name));
  const std::string start = "#include \"";
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with(start) && line.find('"', start.size()) != std::string::npos) {
      const std::string name =
          line.substr(start.size(), line.find('"', start.size()) - start.size());
      out += read(name) + "#line " + std::to_string(number + 1) + "\n";
    } else {
      out += line + "\n";
    }
  }
  return out;
}

Program::Program(const Gl& gl, const ShaderLibrary& library, const std::string& vertex_file,
                 const std::string& fragment_file, const std::string& defines)
    : gl_(&gl) {
  const Shader vertex(gl, GL_VERTEX_SHADER), fragment(gl, GL_FRAGMENT_SHADER);
  vertex.compile(vertex_file, library.source(vertex_file, defines));
  fragment.compile(fragment_file, library.source(fragment_file, defines));
  id_ = gl.CreateProgram();
  gl.AttachShader(id_, vertex.id);
  gl.AttachShader(id_, fragment.id);
  gl.LinkProgram(id_);
  GLint is_linked = 0;
  gl.GetProgramiv(id_, GL_LINK_STATUS, &is_linked);
  if (is_linked) return;
  char log[4096] = "";
  gl.GetProgramInfoLog(id_, sizeof log, nullptr, log);
  gl.DeleteProgram(id_);
  throw std::runtime_error("shaders/" + vertex_file + " and " + fragment_file + " do not link:\n" +
                           log);
}

Program::Program(Program&& other) noexcept : gl_(other.gl_), id_(std::exchange(other.id_, 0)) {}

Program::~Program() {
  if (id_) gl_->DeleteProgram(id_);
}

void Program::use() const {
  gl_->UseProgram(id_);
}

GLint Program::location(const char* name) const {
  return gl_->GetUniformLocation(id_, name);
}

void Program::set(const char* name, float value) const {
  gl_->Uniform1f(location(name), value);
}
void Program::set(const char* name, int value) const {
  gl_->Uniform1i(location(name), value);
}
void Program::set(const char* name, float x, float y) const {
  gl_->Uniform2f(location(name), x, y);
}
void Program::set(const char* name, Vec3f value) const {
  gl_->Uniform3f(location(name), value.x, value.y, value.z);
}

}  // namespace neve::render::gl
