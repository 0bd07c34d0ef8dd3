MODULE Pallet
    PERS robtarget pBase:=[[600,100.5,500],[0.0,0.0,1.0,0.0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    VAR robtarget pNow;
    PROC main()
        FOR i FROM 0 TO 3 DO
            FOR j FROM 0 TO 2 DO
                pNow:=pBase;
                pNow.trans.x:=pBase.trans.x+i*120;
                MoveL pNow,v200,fine,tool0;
                MoveL Offs(pBase,i*120,j*80,0),v200,fine,tool0;
            ENDFOR
        ENDFOR
    ENDPROC
ENDMODULE
