MODULE Search
  VAR robtarget pFound;
  CONST robtarget pFrom:=[[600,100.5,500],[0.0,0.0,1.0,0.0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pTo:=[[600,100.5,500],[0.0,0.0,1.0,0.0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveL \Conc, pFrom,v100,fine,tool0;
    SearchL \Stop, diTouch, pFound, pTo, v20, tool0;
    MoveL pFound,v10,fine,tool0;
    MoveLDO pTo,v100,z10,tool0,doGlue,1;
    TriggL pTo,v100,trig1,z5,tool0;
    MoveExtJ [[9E9,9E9,9E9,9E9,9E9,9E9],[100,9E9,9E9,9E9,9E9,9E9]],vrot10,fine;
  ENDPROC
ENDMODULE
