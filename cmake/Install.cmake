# cmake --install puts neve into a prefix that may be moved: the program finds its scenes from where
# it is. Man pages, completions and schemas come from the program itself, when it is installed.
include(GNUInstallDirs)
# The program alone: tests need not be built first.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)
set(neve_contact "neve developers <neve@neve.invalid>")
set(neve_data ${CMAKE_INSTALL_DATADIR}/neve)
if(NEVE_KERNEL_SETS STREQUAL "native")
  install(CODE "message(FATAL_ERROR \"This build runs on machines like this one alone. Configure it \"
    \"with -DNEVE_KERNEL_SETS=all, and install it then.\")")
elseif(NEVE_KERNEL_SETS STREQUAL "checked")
  install(CODE "message(WARNING \"This build is slow on machines unlike this one: for them configure it \"
    \"with -DNEVE_KERNEL_SETS=all, and install it then.\")")
endif()
install(TARGETS neve RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY scenes shaders DESTINATION ${neve_data} PATTERN make EXCLUDE)
install(FILES python/neve.py python/pyproject.toml DESTINATION ${neve_data}/python)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING
  PATTERN "*.md" PATTERN "*.png" PATTERN "*.jpg" PATTERN "*.webp" PATTERN "*.svg" PATTERN "*.json"
  PATTERN "*.toml" PATTERN "*.csv" PATTERN "*.tsv" PATTERN "*.txt" PATTERN "*.py" PATTERN "*.cpp"
  PATTERN "page.md" EXCLUDE)
# Pages link to scenes beside them.
install(CODE "file(RELATIVE_PATH scenes \"/${CMAKE_INSTALL_DOCDIR}\" \"/${neve_data}/scenes\")
  file(CREATE_LINK \"\${scenes}\"
    \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR}/scenes\" SYMBOLIC)")
set(manual ${PROJECT_BINARY_DIR}/manual)
install(CODE "execute_process(COMMAND \"$<TARGET_FILE:neve>\" manual \"${manual}\"
  COMMAND_ERROR_IS_FATAL ANY)")
foreach(kind scene sweep)
  install(CODE "execute_process(COMMAND \"$<TARGET_FILE:neve>\" schema ${kind}
    OUTPUT_FILE \"${manual}/${kind}.schema.json\" COMMAND_ERROR_IS_FATAL ANY)")
  install(FILES ${manual}/${kind}.schema.json DESTINATION ${neve_data}/schema)
endforeach()
# Policy: manual pages and the changelog are compressed, without a date inside.
install(CODE "file(GLOB pages \"${manual}/man1/*.1\")
  file(WRITE \"${manual}/changelog\" \"neve (${PROJECT_VERSION}) unstable; urgency=medium\n\n  * The commit is that of neve version.\n\n -- ${neve_contact}  Thu, 01 Jan 1970 00:00:00 +0000\n\")
  execute_process(COMMAND gzip -9nf \"${manual}/changelog\" \${pages} COMMAND_ERROR_IS_FATAL ANY)")
install(DIRECTORY ${manual}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} FILES_MATCHING PATTERN "*.gz")
install(FILES ${manual}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${manual}/bash/neve
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${manual}/zsh/_neve DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${manual}/fish/neve.fish
  DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

# cpack -G DEB, in the build folder. What is loaded at run time has to be named.
set(CPACK_PACKAGE_NAME neve)
set(CPACK_PACKAGE_CONTACT "${neve_contact}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
  GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGE_DESCRIPTION "neve simulates snow with the material point method from a scene in TOML, draws
it without a GPU or a display as pictures and films, shows it live in a window
or a web page, studies parameters side by side, and exports particles, surfaces
and volumes for ParaView, Houdini, Blender, USD and numpy.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Without it CPack makes a package that names no library, installs, and does not start.
file(WRITE "${PROJECT_BINARY_DIR}/package_needs.cmake"
  "find_program(NEVE_SHLIBDEPS dpkg-shlibdeps)
if(CPACK_GENERATOR STREQUAL \"DEB\" AND NOT NEVE_SHLIBDEPS)
  message(FATAL_ERROR \"no dpkg-shlibdeps, which finds the libraries that the package needs; apt-get install dpkg-dev\")
endif()
")
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_BINARY_DIR}/package_needs.cmake")
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl1, libegl-mesa0 | libosmesa6, fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "ffmpeg, libosmesa6, python3-numpy")
include(CPack)
