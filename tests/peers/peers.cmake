# Tests that compare with programs of others, in Python: scripts/python-peers installs what they import.

# depthgrid_add_peer_test(messages_peer messages_peer.py message_peer): a script, and the program that it is given
function(depthgrid_add_peer_test name script program)
  add_test(NAME ${name}
    COMMAND "${PROJECT_SOURCE_DIR}/tests/peers/run" "${CMAKE_CURRENT_SOURCE_DIR}/${script}" "$<TARGET_FILE:${program}>"
    WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
  set_tests_properties(${name} PROPERTIES TIMEOUT 600 SKIP_RETURN_CODE 77)
endfunction()
