# neve_build_origin(TARGET FOLDER...): compiles into TARGET the commit, and a fingerprint of the
# sources in FOLDERs, which change results. Both are found out at each build: a commit needs no new
# configuration. See app/support/version.h.
function(neve_build_origin target)
  set(output ${PROJECT_BINARY_DIR}/build_origin.cpp)
  list(JOIN ARGN "|" folders)
  add_custom_target(neve_build_origin_${target} BYPRODUCTS ${output}
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} "-DFOLDERS=${folders}"
            -DOUTPUT=${output} -P ${PROJECT_SOURCE_DIR}/cmake/WriteBuildOrigin.cmake
    VERBATIM)
  add_dependencies(${target} neve_build_origin_${target})
  target_sources(${target} PRIVATE ${output})
  set_source_files_properties(${output} PROPERTIES GENERATED ON SKIP_UNITY_BUILD_INCLUSION ON
    SKIP_PRECOMPILE_HEADERS ON)
endfunction()
