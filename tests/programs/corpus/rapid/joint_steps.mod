MODULE Steps
  CONST jointtarget jA:=[[10,-20,30,0,45,5],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jDelta:=[[0,0,5,0,0,0],[0,0,0,0,0,0]];
  VAR jointtarget jNow;
  PROC main()
    MoveAbsJ jA,v100,fine,tool0;
    jNow:=CJointT();
    jNow.robax.rax_3:=jNow.robax.rax_3+jDelta.robax.rax_3;
    MoveAbsJ jNow,v100,fine,tool0;
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v100,fine,tool0;
  ENDPROC
ENDMODULE
