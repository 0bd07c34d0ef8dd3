MODULE CalPoses
  ! Written by posewright
  CONST jointtarget jPose1:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jPose2:=[[35.5,-20.25,15,-40,60,20],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jPose3:=[[-62.125,25,-25.5,120,-45.75,-170],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC CalMain()
    VelSet 10,250;
    SetDO doMeasure,0;
    ! pose 1
    MoveAbsJ jPose1\NoEOffs,v1000,fine,tool0;
    WaitRob\ZeroSpeed;
    WaitTime 2;
    SetDO doMeasure,1;
    WaitDI diMeasured,1;
    SetDO doMeasure,0;
    WaitDI diMeasured,0;
    ! pose 2
    MoveAbsJ jPose2\NoEOffs,v1000,fine,tool0;
    WaitRob\ZeroSpeed;
    WaitTime 2;
    SetDO doMeasure,1;
    WaitDI diMeasured,1;
    SetDO doMeasure,0;
    WaitDI diMeasured,0;
    ! pose 3
    MoveAbsJ jPose3\NoEOffs,v1000,fine,tool0;
    WaitRob\ZeroSpeed;
    WaitTime 2;
    SetDO doMeasure,1;
    WaitDI diMeasured,1;
    SetDO doMeasure,0;
    WaitDI diMeasured,0;
  ENDPROC
ENDMODULE
