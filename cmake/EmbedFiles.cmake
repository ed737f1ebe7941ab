# neve_embed_files(TARGET NAMESPACE FUNCTION FILE...): compiles files into TARGET as bytes.
# The generated source defines, in NAMESPACE,
#   std::string_view FUNCTION(std::string_view file_name);   // empty for an unknown name
function(neve_embed_files target namespace function)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  list(JOIN ARGN "|" joined)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFUNCTION=${function} -DNAMESPACE=${namespace} "-DFILES=${joined}" -DOUTPUT=${output}
            -P ${PROJECT_SOURCE_DIR}/cmake/WriteEmbeddedSource.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/WriteEmbeddedSource.cmake
    VERBATIM)
  # A command of TARGET alone, and with it all objects of TARGET, would wait for the libraries that
  # TARGET is linked with.
  add_custom_target(${function} DEPENDS ${output})
  add_dependencies(${target} ${function})
  target_sources(${target} PRIVATE ${output})
  # A font is longer than the literals that a compiler must accept; ours accept it.
  set_source_files_properties(${output} PROPERTIES COMPILE_OPTIONS -Wno-overlength-strings)
endfunction()
