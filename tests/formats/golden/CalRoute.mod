MODULE CalRoute
  ! Written by posewright
  CONST jointtarget jHome:=[[0,-28.6479,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jVia1:=[[17.1887,-22.9183,-17.1887,11.4592,28.6479,-14.3239],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jVia2:=[[-17.1887,14.3239,7.162,-11.4592,42.9718,57.2958],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jPose3:=[[-62.125,25,-0.5,120,-45.75,-170],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jPose1:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jPose2:=[[35.5,-20.25,-5.25,-40,60,20],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jVia3:=[[0,0,5.7296,0,11.4592,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC CalMain()
    VelSet 10,250;
    SetDO doMeasure,0;
    ! home
    MoveAbsJ jHome\NoEOffs,v1000,fine,tool0;
    TPWrite "station: Sued";
    TPWrite "load case: empty";
    Stop;
    ! on the way
    MoveAbsJ jVia1\NoEOffs,v1000,fine,tool0;
    MoveAbsJ jVia2\NoEOffs,v1000,fine,tool0;
    ! pose 3
    MoveAbsJ jPose3\NoEOffs,v1000,fine,tool0;
    ! reference targets too: R1
    WaitRob\ZeroSpeed;
    WaitTime 3;
    SetDO doMeasure,1;
    WaitTime 4;
    SetDO doMeasure,0;
    TPWrite "load case: 20 kg";
    Stop;
    ! pose 1
    MoveAbsJ jPose1\NoEOffs,v1000,fine,tool0;
    WaitRob\ZeroSpeed;
    WaitTime 3;
    SetDO doMeasure,1;
    WaitTime 4;
    SetDO doMeasure,0;
    TPWrite "station: Nord";
    Stop;
    ! pose 2
    MoveAbsJ jPose2\NoEOffs,v1000,fine,tool0;
    WaitRob\ZeroSpeed;
    WaitTime 3;
    SetDO doMeasure,1;
    WaitTime 4;
    SetDO doMeasure,0;
    ! on the way
    MoveAbsJ jVia3\NoEOffs,v1000,fine,tool0;
    ! back
    MoveAbsJ jHome\NoEOffs,v1000,fine,tool0;
  ENDPROC
ENDMODULE
