#pragma once
/// Shader programs: source from the binary or a folder, readable errors, uniforms by name.

#include <string>

#include "render/gl/gl.h"
#include "sim/base/vec.h"

namespace neve::render::gl {

/// Source of shader texts.
class ShaderLibrary {
 public:
  /// @param folder read from there instead of the binary when not empty
  explicit ShaderLibrary(std::string folder) : folder_(std::move(folder)) {}

  /// Whole text of a shader: version, defines and the file with every `#include "file"` line
  /// replaced by that file.
  /// @param defines lines such as "#define QUADS\n"
  /// @throws std::runtime_error when a file is missing
  std::string source(const std::string& file_name, const std::string& defines) const;

 private:
  std::string read(const std::string& file_name) const;
  std::string folder_;
};

/// A linked vertex and fragment shader.
class Program {
 public:
  /// @throws std::runtime_error with file name and the compiler's log
  Program(const Gl& gl, const ShaderLibrary& library, const std::string& vertex_file,
          const std::string& fragment_file, const std::string& defines = {});
  Program(Program&& other) noexcept;
  Program& operator=(Program&&) = delete;
  ~Program();

  void use() const;
  // A name that the compiler optimised away is silently ignored, as OpenGL does.
  void set(const char* name, float value) const;
  void set(const char* name, int value) const;
  void set(const char* name, float x, float y) const;
  void set(const char* name, Vec3f value) const;

 private:
  GLint location(const char* name) const;
  const Gl* gl_;
  GLuint id_ = 0;
};

}  // namespace neve::render::gl
