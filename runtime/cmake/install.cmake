# What `cmake --install` lays down, and the Debian packages that `cpack -G DEB` makes of it: `command` (package idim) generates and
# identifies, `development` (package libidim-dev) is for programs that link the runtime. The command and the package configuration
# find what belongs to them relative to their own places, so a tree may be moved as a whole.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS idim RUNTIME DESTINATION bin COMPONENT command)
install(DIRECTORY templates robots DESTINATION share/idim COMPONENT command)
foreach(header model_interface.h effect_interface.h law_interface.h law_adapter.hpp) # what the command compiles with
  install(FILES runtime/include/idim/${header} DESTINATION include/idim COMPONENT command)
  list(APPEND IDIM_HEADERS_OF_COMMAND PATTERN ${header} EXCLUDE)
endforeach()
install(FILES README.md DESTINATION share/doc/idim COMPONENT command)
execute_process(COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/runtime/cli/idim.1 OUTPUT_FILE ${PROJECT_BINARY_DIR}/idim.1.gz
                COMMAND_ERROR_IS_FATAL ANY)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/runtime/cli/idim.1)
install(FILES ${PROJECT_BINARY_DIR}/idim.1.gz DESTINATION share/man/man1 COMPONENT command)

# The configuration does not depend on the machine: a build for another one takes the generator from it.
configure_package_config_file(runtime/cmake/idim-config.cmake.in ${PROJECT_BINARY_DIR}/package/idim-config.cmake
                              INSTALL_DESTINATION share/cmake/idim NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/idim-config-version.cmake COMPATIBILITY SameMinorVersion
                                 ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/package/idim-config.cmake ${PROJECT_BINARY_DIR}/package/idim-config-version.cmake
              runtime/cmake/idim_generate.cmake DESTINATION share/cmake/idim COMPONENT command)

install(TARGETS idim_runtime EXPORT idim-runtime ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        INCLUDES DESTINATION include)
install(EXPORT idim-runtime FILE idim-runtime-targets.cmake NAMESPACE idim:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/idim
        COMPONENT development)
install(DIRECTORY runtime/include/ DESTINATION include COMPONENT development ${IDIM_HEADERS_OF_COMMAND})
file(RELATIVE_PATH IDIM_PREFIX_FROM_PKGCONFIG /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" IDIM_PREFIX_FROM_PKGCONFIG "${IDIM_PREFIX_FROM_PKGCONFIG}")
configure_file(runtime/cmake/idim.pc.in ${PROJECT_BINARY_DIR}/package/idim.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/idim.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# Both packages say their licence and changes where Debian looks for them.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
execute_process(COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md OUTPUT_FILE ${PROJECT_BINARY_DIR}/package/changelog.gz
                COMMAND_ERROR_IS_FATAL ANY)
foreach(package idim:command libidim-dev:development)
  string(REPLACE ":" ";" package ${package})
  list(POP_BACK package component)
  install(FILES LICENSE DESTINATION share/doc/${package} RENAME copyright COMPONENT ${component})
  install(FILES ${PROJECT_BINARY_DIR}/package/changelog.gz DESTINATION share/doc/${package} COMPONENT ${component})
endforeach()

if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own
set(CPACK_PACKAGE_CONTACT "the idim authors <idim@example.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL command development)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME idim)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "g++ | c++-compiler, libidim-dev")
set(CPACK_DEBIAN_COMMAND_DESCRIPTION "symbolic models of robots as generated code, and their identification
The command idim derives the dynamics of a robot from its description,
writes them as code, and identifies their parameters from measured motion
(this needs a C++ compiler). With its templates, robots as examples, and the
CMake function idim_generate.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libidim-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "idim (= ${PROJECT_VERSION}), libeigen3-dev, libfmt-dev, zlib1g-dev, libmd-dev, libnlopt-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "identification of robots, for programs with generated models
Headers and static library of the runtime of idim: logs, filters, estimators,
simulation.")
include(CPack)
