# Headers of the mission: a mission replaces one by a file of its own of this name.
foreach(UPPER_APP_HEADER LOWER_app_topicids.h LOWER_app_perfids.h LOWER_app_msg.h)
    generate_config_includefile(
        FILE_NAME "${UPPER_APP_HEADER}"
        FALLBACK_FILE "${CMAKE_CURRENT_LIST_DIR}/config/default_${UPPER_APP_HEADER}"
    )
endforeach()
