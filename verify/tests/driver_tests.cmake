# Tests of driver/, included by the CMakeLists.txt beside this file.
foreach(name accuracy_test driver_scene_file_test driver_schedule_test driver_trouble_test)
  add_executable(${name} ${CMAKE_CURRENT_LIST_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE bounce_driver GTest::gtest_main)
  gtest_discover_tests(${name} PROPERTIES LABELS driver)
endforeach()

add_executable(driver_memory_test ${CMAKE_CURRENT_LIST_DIR}/driver_memory_test.cpp)
target_compile_definitions(driver_memory_test PRIVATE BOUNCE_PROGRAM="$<TARGET_FILE:bounce>")
target_link_libraries(driver_memory_test PRIVATE bounce_driver GTest::gtest_main)
add_dependencies(driver_memory_test bounce)
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize") # they keep memory of their own
  message(STATUS "driver_memory_test is built but not run under a sanitizer")
else()
  gtest_discover_tests(driver_memory_test PROPERTIES LABELS driver TIMEOUT 120)
endif()
add_executable(driver_extremes_test ${CMAKE_CURRENT_LIST_DIR}/driver_extremes_test.cpp)
target_compile_definitions(driver_extremes_test PRIVATE BOUNCE_PROGRAM="$<TARGET_FILE:bounce>")
target_link_libraries(driver_extremes_test PRIVATE bounce_driver GTest::gtest_main)
add_dependencies(driver_extremes_test bounce)
gtest_discover_tests(driver_extremes_test PROPERTIES LABELS driver TIMEOUT 600)

foreach(name driver_accuracy_test driver_refusal_test driver_run_test driver_stability_test
    driver_step_test)
  add_executable(${name} ${CMAKE_CURRENT_LIST_DIR}/${name}.cpp)
  target_compile_definitions(${name} PRIVATE BOUNCE_PROGRAM="$<TARGET_FILE:bounce>")
  target_link_libraries(${name} PRIVATE bounce_options GTest::gtest_main)
  add_dependencies(${name} bounce)
  gtest_discover_tests(${name} PROPERTIES LABELS driver TIMEOUT 120)
endforeach()

add_executable(driver_reference_test ${CMAKE_CURRENT_LIST_DIR}/driver_reference_test.cpp)
target_compile_definitions(driver_reference_test PRIVATE BOUNCE_PROGRAM="$<TARGET_FILE:bounce>")
target_link_libraries(driver_reference_test PRIVATE bounce_options nlohmann_json::nlohmann_json
  GTest::gtest_main)
add_dependencies(driver_reference_test bounce)
gtest_discover_tests(driver_reference_test PROPERTIES LABELS driver TIMEOUT 120)
