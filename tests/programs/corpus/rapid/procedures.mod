MODULE Procedures
  CONST robtarget pPart:=[[600,100.5,500],[0.0,0.0,1.0,0.0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jSafe:=[[10,-20,30,0,45,5],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    Pick pPart,\Speed:=v100;
    GoTo jSafe;
    Stop;
  ENDPROC
  PROC Pick(robtarget p,\speeddata Speed)
    MoveL p,v100,fine,tool0;
  ENDPROC
  PROC GoTo(jointtarget j)
    MoveAbsJ j,v100,fine,tool0;
  ENDPROC
  FUNC robtarget Above(robtarget p)
    RETURN Offs(p,0,0,50);
  ENDFUNC
ENDMODULE
