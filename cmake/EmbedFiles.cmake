# neve_embed_files(TARGET FUNCTION FILE...): compiles files into TARGET as bytes.
# The generated source defines, in neve::render,
#   std::string_view FUNCTION(std::string_view file_name);   // empty for an unknown name
function(neve_embed_files target function)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  list(JOIN ARGN "|" joined)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFUNCTION=${function} "-DFILES=${joined}" -DOUTPUT=${output}
            -P ${PROJECT_SOURCE_DIR}/cmake/WriteEmbeddedSource.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/WriteEmbeddedSource.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
