MODULE Displaced
  CONST robtarget p1:=[[600,100.5,500],[0.0,0.0,1.0,0.0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jHome:=[[10,-20,30,0,45,5],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jHomePlate:=[[10,-20,30,0,45,5],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ jHome,v100,fine,tool0;
    MoveAbsJ jHomePlate,v100,fine,tool0;
    PDispSet [[0,0,20],[1,0,0,0]];
    MoveL p1,v100,fine,tool0;
    PDispOff;
  ENDPROC
ENDMODULE
