# idim_generate(TARGET <target> ROBOT <robot.yaml> [HEADERS_ONLY])
#
# Generates the models of a robot at build time, into the build tree, and adds them to a target:
#   #include "<robot>/regressor.hpp"     (<robot> is the file's name without .yaml; namespace idim_models::<name in the file>)
# and, unless HEADERS_ONLY is given, the interface for the identifiers, whose accessor is
#   extern "C" const idim_model_interface* idim_model_<robot>(void);
# A change of the robot, of an effect or template, or of the generator regenerates; files that stay the same keep their times.
function(idim_generate)
  cmake_parse_arguments(ARG "HEADERS_ONLY" "TARGET;ROBOT" "" ${ARGN})
  if(NOT ARG_TARGET OR NOT ARG_ROBOT OR ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "idim_generate: expected TARGET <target> ROBOT <robot.yaml> [HEADERS_ONLY], got: ${ARGN}")
  endif()
  get_filename_component(robot_file "${ARG_ROBOT}" ABSOLUTE)
  get_filename_component(robot "${robot_file}" NAME_WE)
  get_filename_component(robot_folder "${robot_file}" DIRECTORY)
  if(NOT EXISTS "${robot_file}")
    message(FATAL_ERROR "idim_generate: no file ${robot_file}")
  endif()

  set(root "${CMAKE_CURRENT_BINARY_DIR}/idim_models")
  set(folder "${root}/${robot}")
  set(files)
  foreach(name regressor inverse_dynamics mass_matrix bias gravity forward_dynamics regroup sines functions model)
    list(APPEND files "${folder}/${name}.hpp")
  endforeach()
  list(APPEND files "${folder}/model_interface.cpp")

  if(NOT TARGET idim_generate_${robot})
    get_property(templates GLOBAL PROPERTY IDIM_TEMPLATES)
    file(GLOB inputs CONFIGURE_DEPENDS "${templates}/cpp/*" "${templates}/effects/*" "${robot_folder}/*.yaml")
    add_custom_command(
      OUTPUT "${folder}/generated.stamp"
      BYPRODUCTS ${files}
      COMMAND idim generate "${robot_file}" -o "${folder}"
      COMMAND ${CMAKE_COMMAND} -E touch "${folder}/generated.stamp"
      DEPENDS idim "${robot_file}" ${inputs}
      COMMENT "idim: models of ${robot}"
      VERBATIM)
    add_custom_target(idim_generate_${robot} DEPENDS "${folder}/generated.stamp")
  endif()

  add_dependencies(${ARG_TARGET} idim_generate_${robot})
  target_include_directories(${ARG_TARGET} PRIVATE "${root}")
  if(NOT ARG_HEADERS_ONLY)
    set_source_files_properties("${folder}/model_interface.cpp" PROPERTIES GENERATED TRUE
                                COMPILE_DEFINITIONS "IDIM_MODEL_SYMBOL=idim_model_${robot}")
    target_sources(${ARG_TARGET} PRIVATE "${folder}/model_interface.cpp")
    target_link_libraries(${ARG_TARGET} PRIVATE idim::runtime)
  endif()
endfunction()
